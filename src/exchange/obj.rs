//! OBJ files: reads polygons and materials.
//!
//! **Lines.** A line ends with LF, CR or both. A statement is a keyword and its arguments, separated by
//! blanks or tabs; a backslash at the end of a line continues it. `#` begins a comment, also after arguments.
//! A comment or a skipped statement ends with its line even if there is a backslash, so that no name like
//! `C:\` can swallow a face.
//!
//! **`v`** and three finite coordinates. More numbers may follow (a weight, which has no meaning for
//! polygons, or a colour) and are skipped. A coordinate becomes the nearest `f64`.
//!
//! **`f`** and three or more corners, each `v`, `v/vt`, `v//vn` or `v/vt/vn`; textures and normals are
//! skipped, and their existence is not checked. Vertices are counted from 1; -1 is the last vertex before the
//! face. A face may precede its vertices. `fo`, which old files use, means the same.
//!
//! **`usemtl`** names the material of the faces that follow: the rest of its line, up to a blank and `#`.
//! Without a name the faces have none. Files of materials (`mtllib`) are not read.
//!
//! **Skipped** are all other statements: textures, normals, points, lines, groups, names, curves, and unknown
//! keywords. All groups and objects become one mesh.
//!
//! **Refused** are statements whose loss would change the shape: surfaces that are no polygons (`surf`,
//! `bsp`, `bzp`) and parts in another file (`call`). A file with neither `v` nor `f` is refused as well.

use alloc::vec::Vec;

use super::materials::Materials;
use super::polygons::Polygons;
use super::text::Text;
use super::{is_line_end, is_space, refuse_utf16};
use crate::error::{Error, MeshFileError};
use crate::memory;
use crate::mesh::TriangleMesh;

/// Reads an OBJ file; all of its groups and objects become one mesh.
///
/// Triangles keep the order of the faces. A face of more than three corners is triangulated within the face.
/// If that is impossible, because its edges cross or it has no area, it becomes the fan around its first
/// corner. Equal vertices are welded, and triangles that become degenerate by that are dropped and counted,
/// as in [`TriangleMesh::new`]. The mesh need not be closed, and may be empty. If `usemtl` names materials,
/// they become the attribute `material`.
///
/// O(n), or O(n log n) for faces that are not convex. Memory is at most 128 times the length of the file.
///
/// # Errors
/// [`MeshFileError::Empty`], [`MeshFileError::Unsupported`] (UTF-16), [`MeshFileError::Syntax`],
/// [`MeshFileError::Index`], [`MeshError::TooLarge`](crate::error::MeshError::TooLarge),
/// [`MeshError::TooMany`](crate::error::MeshError::TooMany) or [`Error::OutOfMemory`].
pub fn read_obj(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    if bytes.is_empty() {
        return Err(MeshFileError::Empty.into());
    }
    refuse_utf16(bytes)?;
    let mut file = Reader::default();
    file.read(Text::new(bytes))?;
    let vertices = file.mesh.vertices.len() as u64;
    if file.most > vertices {
        // Some face refers to a vertex that does not exist: the first such face is found by reading again.
        drop(file);
        file = Reader { limit: Some(vertices), ..Reader::default() };
        file.read(Text::new(bytes))?;
    }
    let Reader { mesh, materials, .. } = file;
    mesh.finish_with(|triangles| materials.attributes(triangles.len()))
}

#[derive(Default)]
struct Reader<'a> {
    mesh: Polygons,
    materials: Materials<'a>,
    corners: Vec<u32>,
    /// The greatest vertex number in a face, counted from 1.
    most: u64,
    /// The total number of vertices, if it is known.
    limit: Option<u64>,
}

impl<'a> Reader<'a> {
    fn read(&mut self, mut text: Text<'a>) -> Result<(), Error> {
        let mut any = false;
        loop {
            text.skip_space();
            let mut ahead = text;
            match keyword(&mut ahead) {
                b"v" => {
                    self.read_vertex(&mut ahead)?;
                    any = true;
                }
                b"f" | b"fo" => {
                    self.read_face(&mut ahead)?;
                    any = true;
                }
                b"usemtl" => {
                    self.materials.begin(self.mesh.triangle_count())?;
                    self.materials.choose(ahead.rest())?;
                    ahead.skip_line();
                }
                b"surf" | b"bsp" | b"bzp" => {
                    let expected =
                        "polygons (`f`); surfaces of other kinds (`surf`, `bsp`, `bzp`) cannot be read";
                    return Err(text.error(expected).into());
                }
                b"call" => {
                    return Err(text
                        .error("a statement other than `call`: a mesh must be in one file")
                        .into());
                }
                b"" if ahead.is_at_line_end() => {
                    return if any { Ok(()) } else { Err(text.error(NOTHING).into()) };
                }
                _ => ahead.skip_line(),
            }
            text = ahead;
        }
    }

    /// Reads the arguments of `v`.
    #[inline]
    fn read_vertex(&mut self, text: &mut Text) -> Result<(), Error> {
        let mut vertex = [0.0; 3];
        for x in &mut vertex {
            skip_gap(text);
            *x = text.number().ok_or_else(|| text.error("`v` and three finite numbers"))?;
        }
        loop {
            skip_gap(text);
            match text.rest() {
                // Any printed form of a number, such as `-nan(ind)`, but no statement whose line end was
                // lost.
                [b'0'..=b'9' | b'+' | b'-' | b'.' | b'i' | b'I' | b'n' | b'N', ..] => {
                    text.word();
                }
                [] | [b'#' | b'\n' | b'\r', ..] => break,
                _ => return Err(text.error("a number, or the end of the line").into()),
            }
        }
        text.skip_line();
        self.mesh.push_vertex(vertex)
    }

    /// Reads the arguments of `f`.
    #[inline]
    fn read_face(&mut self, text: &mut Text) -> Result<(), Error> {
        self.corners.clear();
        loop {
            skip_gap(text);
            if matches!(text.rest(), [] | [b'#' | b'\n' | b'\r', ..]) {
                break;
            }
            let corner = self.read_corner(text)?;
            memory::push(&mut self.corners, corner)?;
        }
        if self.corners.len() < 3 {
            return Err(text.error("a face of at least three corners").into());
        }
        text.skip_line();
        self.mesh.push_face(&self.corners)?;
        self.materials.give(self.mesh.triangle_count())
    }

    /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[inline]
    fn read_corner(&mut self, text: &mut Text) -> Result<u32, Error> {
        let start = *text;
        let index = integer(text).ok_or_else(|| start.error(CORNER))?;
        // Skip texture and normal.
        for _ in 0..2 {
            if let [b'/', rest @ ..] = text.rest() {
                text.continue_with(rest);
                let _ = integer(text);
            }
        }
        match text.rest() {
            [] | [b'#', ..] => {}
            [byte, ..] if is_space(*byte) => {}
            rest if continuation(rest).is_some() => {}
            _ => return Err(start.error(CORNER).into()),
        }
        let known = self.mesh.vertices.len() as u64;
        // Vertices are counted from 1.
        let number = match u64::try_from(index) {
            Ok(index) => Some(index),
            Err(_) => known.checked_sub(index.unsigned_abs()).map(|before| before + 1),
        };
        match number {
            Some(number) if (1..=self.limit.unwrap_or(u32::MAX.into())).contains(&number) => {
                self.most = self.most.max(number);
                Ok((number - 1) as u32)
            }
            _ => {
                let vertices = self.limit.unwrap_or(known);
                Err(MeshFileError::Index { line: start.line(), index, vertices }.into())
            }
        }
    }
}

const NOTHING: &str = "vertices (`v`) and faces (`f`), but this file has neither";
const CORNER: &str = "numbers of vertices, such as 7, 7/1, 7//2 or 7/1/2";

/// Takes the first word of a statement; empty at the end of the text.
#[inline]
fn keyword<'a>(text: &mut Text<'a>) -> &'a [u8] {
    match text.rest() {
        [b'v', rest @ ..] | [b'f', rest @ ..] if matches!(rest, [b' ' | b'\t', ..]) => {
            let word = &text.rest()[..1];
            text.continue_with(rest);
            word
        }
        // A continuation may follow immediately.
        rest => {
            let length = rest.iter().position(|&b| is_space(b) || b == b'\\').unwrap_or(rest.len());
            let (word, rest) = rest.split_at(length);
            text.continue_with(rest);
            word
        }
    }
}

/// Takes an integer, whatever follows it.
#[inline]
fn integer(text: &mut Text) -> Option<i64> {
    let (integer, rest) = super::decimal::integer(text.rest())?;
    text.continue_with(rest);
    Some(integer)
}

/// Takes blanks and continuations.
#[inline]
fn skip_gap(text: &mut Text) {
    loop {
        text.skip_blanks();
        match continuation(text.rest()) {
            Some(rest) => text.continue_with(rest),
            None => return,
        }
    }
}

/// Returns the text after a backslash and a line end.
#[inline]
fn continuation(rest: &[u8]) -> Option<&[u8]> {
    match rest {
        [b'\\', b'\r', b'\n', rest @ ..] => Some(rest),
        [b'\\', byte, rest @ ..] if is_line_end(*byte) => Some(rest),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::tests::{is_syntax_error, model, random_polygons, same, truncations_and_damages};
    use super::*;
    use crate::error::MeshError;
    use crate::mesh::FillRule;
    use alloc::string::String;
    use alloc::{format, vec};
    use proptest::prelude::*;

    const CORNERS: &str = "v 0 0 0\nv 1.5 0 0\nv 0 2.25 0\nv 0 0 1e-3\n";
    const FACES: &str = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

    /// A tetrahedron.
    fn plain() -> String {
        format!("{CORNERS}{FACES}")
    }

    #[track_caller]
    fn assert_tetrahedron(bytes: impl AsRef<[u8]>) {
        let mesh = read_obj(bytes.as_ref()).unwrap();
        assert_eq!(mesh.vertices(), [[0., 0., 0.], [1.5, 0., 0.], [0., 2.25, 0.], [0., 0., 1e-3]]);
        assert_eq!(mesh.triangles(), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        mesh.check_closed(FillRule::NonZero).unwrap();
    }

    #[track_caller]
    fn assert_syntax(text: impl AsRef<[u8]>, at: u64, what: &str) {
        is_syntax_error(read_obj(text.as_ref()), at, what);
    }

    #[track_caller]
    fn assert_index(text: impl AsRef<[u8]>, at: u64, vertex: i64, count: u64) {
        match read_obj(text.as_ref()) {
            Err(Error::MeshFile(MeshFileError::Index { line, index, vertices })) => {
                assert_eq!((line, index, vertices), (at, vertex, count));
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn vertices_and_faces() {
        assert_tetrahedron(plain());
        assert_tetrahedron(plain().trim_end());
        let corners = |of: fn(i32) -> String| {
            let face = |f: [i32; 3]| format!("f {} {} {}\n", of(f[0]), of(f[1]), of(f[2]));
            format!("{CORNERS}{}", [[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]].map(face).concat())
        };
        assert_tetrahedron(corners(|v| format!("{v}/7")));
        assert_tetrahedron(corners(|v| format!("{v}/{v}/-1")));
        assert_tetrahedron(corners(|v| format!("{v}//{v}")));
        assert_tetrahedron(corners(|v| format!("{v}/")));
        assert_tetrahedron(corners(|v| format!("{v}//")));
        assert_tetrahedron(corners(|v| format!("{}", v - 5)));
        assert_tetrahedron(corners(|v| format!("{}/-1/-1", v - 5)));
        assert_tetrahedron(corners(|v| format!("+000{v}")));
        assert_tetrahedron(plain().replace("f ", "fo "));
    }

    #[test]
    fn relative_indices_count_from_the_face() {
        let (first, rest) = CORNERS.split_at(CORNERS.rfind('v').unwrap());
        assert_tetrahedron(format!("{first}f -3 -1 -2\n{rest}f -4 -3 -1\nf -3 -2 -1\nf -2 -4 -1\n"));
        assert_index(format!("{CORNERS}f -1 -2 -4\nf -1 -2 -5\n"), 6, -5, 4);
        assert_index(format!("{first}f -1 -2 -4\n{rest}"), 4, -4, 3);
        assert_index("f -1 -1 -1\n", 1, -1, 0);
    }

    #[test]
    fn faces_before_their_vertices() {
        assert_tetrahedron(format!("{FACES}{CORNERS}"));
        assert_tetrahedron(CORNERS.replacen("v 0 2", "f 1 3 2\nv 0 2", 1) + &FACES[8..]);
        // The error names the first face with a missing vertex, though a later face has a greater number.
        assert_index(format!("f 1 2 3\nf 1 2 4\nf 1 2\\\n 5\nf 1 2 9\n{CORNERS}"), 4, 5, 4);
        assert_index(plain() + "f 1 2 5\n", 9, 5, 4);
    }

    #[test]
    fn indices_that_are_none() {
        assert_index(plain() + "f 0 1 2\n", 9, 0, 4);
        assert_index(plain() + "f -0 1 2\n", 9, 0, 4);
        assert_index(plain() + "f 1 2 4294967296\n", 9, 4_294_967_296, 4);
        assert_index(plain() + "f 1 2 4294967295\n", 9, 4_294_967_295, 4);
        assert_index(plain() + "f 1 2 -999999999999999999\n", 9, -999_999_999_999_999_999, 4);
        assert_syntax(plain() + "f 1 2 9999999999999999999\n", 9, "7/1/2");
        for corner in ["x", "/1", "1.5", "1e0", "1/x", "1/1/x", "1/1/1/1", "1///1", "1,2", "1-2", "-", "--1"]
        {
            assert_syntax(format!("{}\nf 1 2 {corner}\n", plain()), 10, "7/1/2");
        }
    }

    #[test]
    fn faces_need_three_corners() {
        for face in ["f", "f ", "f 1", "f 1 2", "f 1 2 # 3", "f 1/1 2/2", "f \\\n1 2"] {
            let line = 9 + face.contains('\n') as u64;
            assert_syntax(format!("{}{face}\n", plain()), line, "three corners");
            assert_syntax(format!("{}{face}", plain()), line, "three corners");
        }
        // Triangles with two equal corners are dropped by the mesh, and counted.
        let report = read_obj((plain() + "f 1 1 2\n").as_bytes()).unwrap().report().unwrap();
        assert_eq!((report.facets_read, report.degenerate), (5, 1));
    }

    #[test]
    fn blanks_comments_and_line_ends() {
        let plain = plain();
        assert_tetrahedron(plain.replace('\n', "\r\n"));
        assert_tetrahedron(plain.replace('\n', "\r"));
        assert_tetrahedron(plain.replace('\n', "\n\n \t\n"));
        assert_tetrahedron(plain.replace(' ', "\t"));
        assert_tetrahedron(plain.replace(' ', " \t "));
        assert_tetrahedron(plain.replace('\n', " \n\t"));
        assert_tetrahedron(plain.replace('\n', "#comment\n# v 1 2 3\n"));
        assert_tetrahedron(plain.replace('\n', " # f 1 2 3\r\n"));
        assert_tetrahedron(format!("\u{FEFF}{plain}"));
        assert_tetrahedron(format!("{plain}\x1A\0\0"));
        assert_tetrahedron(format!("# Gr\u{fc}\u{df}e\n{plain}"));
        assert_tetrahedron([b"g M\xFCller\n#\xFF\n", plain.as_bytes()].concat());
    }

    #[test]
    fn continuations() {
        let plain = plain();
        for end in ["\n", "\r\n", "\r"] {
            assert_tetrahedron(plain.replace(' ', &format!(" \\{end} ")));
            assert_tetrahedron(plain.replace(' ', &format!("\\{end}")));
            assert_tetrahedron(plain.replace(' ', &format!(" \\{end}\\{end}\t")));
            assert_tetrahedron(plain.replace('\n', &format!(" \\{end}{end}")));
        }
        // A backslash is no continuation in comments and in skipped statements.
        assert_tetrahedron(plain.replace('\n', " # C:\\\n"));
        assert_tetrahedron(plain.replace("f ", "usemtl C:\\\nf "));
        assert_tetrahedron(plain.replace("f ", "g a b \\\nc d\nf "));
        // A backslash elsewhere is a syntax error.
        assert_syntax(plain.clone() + "f 1 2 \\ 3\n", 9, "7/1/2");
        assert_syntax(plain.clone() + "f 1 2 3 \\", 9, "7/1/2");
    }

    #[test]
    fn other_statements_are_skipped() {
        let others = "mtllib\nmtllib a.mtl b.mtl\nusemtl\nusemtl \ng\ng a b\no\no part\ns\ns off\ns 1\nl 1 2\np 1\n\
             vt 0\nvt 0.5 nan\nvn 0 0 1\nvp 0.5\nbevel on\nlod 1\nmg 1 0.5\ncstype rat bezier\ndeg 3\n\
             curv 0 1 1 2 3 4\nparm u 0 1\ntrim 0 1 1\nend\nhello\nface 1 2\nvertex 1\nF 1 2\n\u{ff}\0\n\\\n/\n";
        assert_tetrahedron([others.as_bytes(), plain().as_bytes()].concat());
        assert_tetrahedron(format!("{CORNERS}{}{FACES}", others));
        let apart = FACES.replace('\n', "\ng part\nusemtl \n");
        assert_tetrahedron(format!("{CORNERS}{apart}"));
    }

    #[test]
    fn what_would_be_missed_is_refused() {
        assert_syntax(plain() + "surf 0 1 0 1 1 2 3 4\n", 9, "surfaces of other kinds");
        assert_syntax(plain() + "bzp 1 2 3 4\n", 9, "surfaces of other kinds");
        assert_syntax(plain() + "bsp 1 2 3 4\n", 9, "surfaces of other kinds");
        assert_syntax(plain() + "call other.obj\n", 9, "one file");
    }

    #[test]
    fn texts_that_are_no_obj() {
        assert!(matches!(read_obj(b""), Err(Error::MeshFile(MeshFileError::Empty))));
        assert_syntax("\n", 1, "neither");
        assert_syntax("# nothing\n\n", 1, "neither");
        assert_syntax("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", 4, "neither");
        assert_syntax("ply\nformat ascii 1.0\n", 2, "neither");
        assert_syntax([0; 100], 1, "neither");
        // A file of vertices alone is a file without faces.
        assert_eq!(read_obj(CORNERS.as_bytes()).unwrap().triangles().len(), 0);
    }

    #[test]
    fn weights_and_colours_are_skipped() {
        for more in
            [" 1", " 1 0 0.5", " 255 0 0 255", " nan -nan(ind) 1.#INF", " .5", " -1e5 # red", " \\\n 1 0 0"]
        {
            assert_tetrahedron(plain().replacen(" 0\n", &format!(" 0{more}\n"), 1));
        }
        // A lost line end would lose a vertex or a face.
        assert_syntax(plain().replacen(" 0\nv", " 0 v", 1), 1, "end of the line");
        assert_syntax(plain().replacen("1e-3\nf", "1e-3 f", 1), 4, "end of the line");
    }

    #[test]
    fn coordinates() {
        let read = |number: &str| {
            read_obj(plain().replace("1.5", number).as_bytes()).map(|mesh| mesh.vertices()[1][0])
        };
        let numbers = [
            ("1e-3", 1e-3),
            (".5", 0.5),
            ("-.5", -0.5),
            ("1.", 1.0),
            ("+1", 1.0),
            ("1E+05", 1e5),
            ("0.1", 0.1),
            ("1e-999", 0.0),
            ("0.0815609375", 0.0815609375),
            ("123456789012345678901", 1.2345678901234568e20),
        ];
        for (text, value) in numbers {
            assert_eq!(read(text).unwrap(), value);
        }
        for text in [
            "nan", "-nan", "inf", "Infinity", "1e999", "1d3", "1,5", "1/2", "0x10", "1.5f", "--1", "1_0", "",
            "\u{661}",
        ] {
            let text = plain().replacen("1.5 0 0", &format!("{text} 0"), 1);
            assert_syntax(text, 2, "three finite numbers");
        }
        assert_syntax("v 1 2\nv 1 2 3\n", 1, "three finite numbers");
        assert_syntax("v\n", 1, "three finite numbers");
        assert_syntax("v 1 2 3\nv 1 2", 2, "three finite numbers");
        assert!(matches!(read("1e78"), Err(Error::Mesh(MeshError::TooLarge { vertex: 1 }))));
    }

    #[test]
    fn polygons() {
        // A cube.
        let corners: String = (0..8).map(|i| format!("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2)).collect();
        let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
        let mesh = read_obj(format!("{corners}{faces}").as_bytes()).unwrap();
        assert_eq!((mesh.triangles().len(), mesh.volume()), (12, 1.0));
        mesh.check_closed(FillRule::NonZero).unwrap();
    }

    #[test]
    fn truncated_and_damaged() {
        let text = plain().replace("f 2 3", "# c\r\nf 2/1/1 \\\n 3//1") + "vn 1 2 3\nf -1 -2 -3 -4\n";
        truncations_and_damages(read_obj, text.as_bytes());
        // Cuts inside of a number or between lines cannot be detected; all others are.
        for length in (0..text.len()).filter(|&length| text.is_char_boundary(length)) {
            if let Ok(mesh) = read_obj(&text.as_bytes()[..length]) {
                let last = text[..length].lines().rfind(|line| !line.is_empty()).unwrap();
                assert!(mesh.triangles().is_empty() || !matches!(last.trim(), "f" | "v"), "{last}");
            }
        }
    }

    proptest! {
        #![proptest_config(leafless_testkit::cases(1000))]

        /// Any mesh, written in any dialect.
        #[test]
        fn written_meshes_come_back(
            (vertices, faces) in random_polygons(),
            style in any::<[u8; 5]>(),
        ) {
            let mut text = String::new();
            let gap = [" ", "  ", "\t", " \\\n ", "\\\r\n"][style[0] as usize % 5];
            let end = ["\n", "\r\n", "\r", " # c\n", "\n\ng x\n"][style[1] as usize % 5];
            for (i, [x, y, z]) in vertices.iter().enumerate() {
                let more = ["", " 1", " 0.5 0.5 1"][(style[2] as usize + i * style[3] as usize) % 3];
                text += &format!("v{gap}{x}{gap}{y:e}{gap}{z}{more}{end}");
            }
            let mut faces_text = String::new();
            let before = style[4] % 2 == 0;
            for face in &faces {
                faces_text += "f";
                for (k, &v) in face.iter().enumerate() {
                    let relative = !before && (k + style[3] as usize).is_multiple_of(2);
                    let index = if relative { v as i64 - vertices.len() as i64 } else { v as i64 + 1 };
                    let more = ["", "/1", "//2", "/1/2"][style[2] as usize % 4];
                    faces_text += &format!("{gap}{index}{more}");
                }
                faces_text += end;
            }
            let text = if before { faces_text + &text } else { text + &faces_text };
            same(read_obj(text.as_bytes()).unwrap(), vertices, &faces);
        }

        #[test]
        fn any_text(text in "[vfo #/\\\\\r\n\t0-9.e+-]{0,200}") {
            let _ = read_obj(text.as_bytes());
        }
    }

    #[test]
    fn real_files() {
        let facts = [
            ("stanford-bunny.obj", 69_451, 35_947, None),
            ("spot.obj", 5_856, 2_930, None),
            ("fandisk.obj", 12_946, 6_475, Some(20.243375)),
            ("rocker-arm.obj", 20_088, 10_044, Some(0.042514)),
            ("wallhole.obj", 66, 35, None),
        ];
        for (name, triangles, vertices, volume) in facts {
            let Some(bytes) = model(name) else { return };
            let mesh = read_obj(&bytes).unwrap();
            let report = mesh.report().unwrap();
            assert_eq!((report.facets_read, report.vertices), (triangles, vertices), "{name}");
            if let Some(volume) = volume {
                mesh.check_closed(FillRule::NonZero).unwrap();
                assert!((mesh.volume() - volume).abs() < 1e-6, "{name}: {}", mesh.volume());
            }
        }
    }

    #[test]
    fn long_lines_take_linear_time() {
        let many = vec!["1"; 300_000].join(" ");
        assert_eq!(
            read_obj(format!("{CORNERS}f {many}\n").as_bytes()).unwrap().report().unwrap().degenerate,
            299_998
        );
        assert_tetrahedron(format!("{}{many}\n{}", "g ", plain()));
        assert_tetrahedron(plain().replacen(' ', &"\\\n".repeat(300_000), 1));
    }
}
