//! Pictures of layers: rendering into the host's buffers, PNG files, legends.

use super::boundary::{Failure, Out, Sized32, buffer, guard, out, shared, sized, slice, text};
use super::camera::leafless_camera;
use super::control::{controlled, leafless_options};
use super::layer::{clip, leafless_layer, leafless_transfer};
use super::number::{Number, enumeration};
use super::source::{leafless_sink, sink};
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::memory;
use leafless::render::{
    Clip, ClippedLayer, Layer, LegendBox, LegendSide, Picture, Shot, draw_colour_bar, draw_names, render,
    write_png,
};

/// The parameters of a picture. The size and the camera must be set; zero is the default of all other fields
/// but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_shot {
    /// sizeof(leafless_shot).
    pub struct_size: u32,
    /// Pixels of a row, 1 to 16384.
    pub width: u32,
    /// Rows, 1 to 16384.
    pub height: u32,
    /// Samples of a pixel, on a grid: 1, 4, 9, 16, 25, 36, 49 or 64; 0 means 4.
    pub samples: u32,
    /// The camera.
    pub camera: leafless_camera,
    /// 4 · `clip_plane_count` numbers: a, b, c and d of each plane, which cuts away the points with
    /// a x + b y + c z + d < 0.
    pub clip_planes: *const f64,
    /// Number of clip planes.
    pub clip_plane_count: u64,
    /// 6 numbers, the least and the greatest corner of a box; everything outside it is cut away. NULL means
    /// none.
    pub clip_box_model: *const f64,
    /// The background colour: red, green, blue (sRGB) and opacity. All zero means transparent.
    pub background: [u8; 4],
    /// Reserved; 0.
    pub reserved: u32,
}

// SAFETY: numbers and pointers.
unsafe impl Sized32 for leafless_shot {}

impl leafless_shot {
    /// # Safety
    /// The pointers are NULL or misaligned, or point to as many numbers as the fields say.
    unsafe fn check(&self) -> Result<Shot, Failure> {
        if self.reserved != 0 {
            return Err(Failure::Argument { name: "shot.reserved", problem: "must be 0" });
        }
        let names = ["shot.clip_planes", "shot.clip_box_model"];
        // SAFETY: the caller's promise.
        let clip = unsafe {
            clip(Clip::new(), self.clip_planes, self.clip_plane_count, self.clip_box_model, names)?
        };
        Ok(Shot {
            camera: self.camera.check()?,
            size: [self.width, self.height],
            samples: if self.samples == 0 { 4 } else { self.samples },
            clip,
            background: self.background,
        })
    }
}

/// Returns the line of sight of a position in a picture, in pixels from its upper left corner: the middle of
/// the first pixel is 0.5, 0.5. A point visible there at the depth d is `from_model` + d · `direction`.
///
/// - Buffers: `shot`, one struct; `from_model` and `direction`, 3 numbers each.
/// - Result: `from_model`, the start of the line of sight; `direction`, with the component 1 along the view.
/// - Errors: LEAFLESS_E_ARGUMENT if the camera or the size is invalid.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[from_model; 3], [direction; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_shot_line_of_sight(
    shot: *const leafless_shot,
    x: f64,
    y: f64,
    from_model: *mut f64,
    direction: *mut f64,
) -> leafless_status {
    guard(|| unsafe {
        shared(shot, "shot")?;
        let shot = sized(shot, "shot")?.check()?;
        let from_model = out(from_model.cast::<[f64; 3]>(), "from_model")?;
        let direction = out(direction.cast::<[f64; 3]>(), "direction")?;
        if shot.size.contains(&0) {
            return Err(Failure::Argument { name: "shot.width", problem: "and height must be above 0" });
        }
        let (from, along) = shot.line_of_sight([x, y]);
        from_model.write(from)?;
        direction.write(along)
    })
}

/// Renders a picture of layers. Surfaces hide objects behind them in all layers; of two surfaces at one depth
/// that of the first layer is visible. The bytes are identical for any number of threads.
///
/// - Buffers: `shot`, one struct; `layers`, `layer_count` handles; `options`, one struct or NULL; `colours`,
///   room for `colour_capacity` bytes, and `depths`, room for `depth_capacity` numbers, each NULL if it is
///   not wanted.
/// - Result: in `colours` 4 · width · height bytes: red, green, blue (sRGB, not multiplied by the opacity)
///   and opacity of each pixel, row by row from the upper left corner without gaps. In `depths` width ·
///   height numbers: the distance from the plane of the eye to the nearest opaque point, in model units;
///   infinity if there is none, or if it is beyond the range of float.
/// - Errors: LEAFLESS_E_ARGUMENT if the shot is invalid; LEAFLESS_E_BUFFER if a capacity is too small:
///   nothing is written then; the errors of solids and attributes of layers; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_CANCELLED.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any layers, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_picture_render(
    shot: *const leafless_shot,
    layers: *const *const leafless_layer,
    layer_count: u64,
    options: *const leafless_options,
    colours: *mut u8,
    colour_capacity: u64,
    depths: *mut f32,
    depth_capacity: u64,
) -> leafless_status {
    guard(|| unsafe {
        shared(shot, "shot")?;
        let shot = sized(shot, "shot")?.check()?;
        let layers = slice(layers, layer_count, "layers")?;
        let (colours, depths) =
            (buffer(colours, colour_capacity, "colours")?, buffer(depths, depth_capacity, "depths")?);
        let pixels = shot.size[0] as usize * shot.size[1] as usize;
        colours.check(pixels.saturating_mul(4))?;
        depths.check(pixels)?;
        let mut handles = memory::with_capacity(layers.len())?;
        let mut whole: Vec<Box<dyn Layer>> = memory::with_capacity(layers.len())?;
        for &layer in layers {
            let layer = shared(layer, "layers")?;
            handles.push(layer);
            whole.push(layer.layer()?);
        }
        let mut clipped: Vec<Option<ClippedLayer>> = memory::with_capacity(layers.len())?;
        for (handle, layer) in handles.iter().zip(&whole) {
            clipped.push(handle.clipped(&**layer));
        }
        let mut shown: Vec<&dyn Layer> = memory::with_capacity(layers.len())?;
        for (layer, clipped) in whole.iter().zip(&clipped) {
            shown.push(clipped.as_ref().map_or(&**layer, |clipped| clipped as &dyn Layer));
        }
        let picture = controlled(options, |control| render(&shot, &shown, control))?;
        colours.fill(picture.bytes())?;
        depths.fill(picture.depths())
    })
}

/// Returns the host's colours as a picture.
///
/// # Safety
/// As [`slice`] for 4 · width · height bytes.
unsafe fn picture(colours: *const u8, width: u32, height: u32) -> Result<Picture, Failure> {
    // SAFETY: the caller's promise.
    let colours: &[[u8; 4]] =
        unsafe { slice(colours.cast(), u64::from(width).saturating_mul(u64::from(height)), "colours")? };
    Ok(Picture::of_colours([width, height], memory::copied(colours)?)?)
}

/// Writes a picture as a PNG file: without opacity if all pixels are opaque. The same picture makes the same
/// bytes.
///
/// - Buffers: `colours`, 4 · `width` · `height` bytes, as written by leafless_picture_render; `sink`, one
///   struct.
/// - Errors: LEAFLESS_E_ARGUMENT unless the sides are 1 to 16384 pixels; LEAFLESS_E_IO; LEAFLESS_E_CALLBACK;
///   LEAFLESS_E_BUFFER; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_picture_write(
    colours: *const u8,
    width: u32,
    height: u32,
    sink: *const leafless_sink,
) -> leafless_status {
    guard(|| unsafe {
        let picture = picture(colours, width, height)?;
        let sink = self::sink(sink)?;
        sink.put_whole(&write_png(&picture)?)
    })
}

/// The side of a picture where a legend lies.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_legend_side {
    /// In the middle of the right side, at most a third of the width.
    LEAFLESS_LEGEND_SIDE_RIGHT = 0,
    /// In the middle of the lower side, at most a third of the height.
    LEAFLESS_LEGEND_SIDE_BOTTOM = 1,
}

enumeration! {
    leafless_legend_side => LegendSide {
        LEAFLESS_LEGEND_SIDE_RIGHT => LegendSide::Right,
        LEAFLESS_LEGEND_SIDE_BOTTOM => LegendSide::Bottom,
    }
}

/// The part of a picture that a legend covers; all zero if there is none.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_legend_box {
    /// Pixels to the left of the legend.
    pub left: u32,
    /// Rows above the legend.
    pub top: u32,
    /// Its width in pixels.
    pub width: u32,
    /// Its height in pixels.
    pub height: u32,
}

/// Draws a legend into the host's colours and returns its box.
///
/// # Safety
/// As [`super::boundary::exclusive`] for 4 · width · height bytes.
unsafe fn drawn(
    colours: *mut u8,
    [width, height]: [u32; 2],
    covered: Out<leafless_legend_box>,
    draw: impl FnOnce(&mut Picture) -> Result<Option<LegendBox>, Failure>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let mut picture = picture(colours, width, height)?;
        let [left, top, wide, high] = draw(&mut picture)?.unwrap_or_default();
        buffer(colours, picture.bytes().len() as u64, "colours")?.fill(picture.bytes())?;
        covered.write(leafless_legend_box { left, top, width: wide, height: high })
    }
}

/// Draws a bar of the colours of values over a transfer function's range into a picture, with a title and
/// numbers, on a light panel. Titles that are too long are cut.
///
/// - Buffers: `colours`, 4 · `width` · `height` bytes, as leafless_picture_render writes them; `title`,
///   `title_length` bytes of UTF-8; `transfer`, one struct; `covered`, one struct. `side` is a
///   leafless_legend_side.
/// - Result: the picture with the legend; in `*covered` the box that it covers, all zero if the picture is
///   smaller than 160 x 120 pixels, which has no legend.
/// - Errors: LEAFLESS_E_ARGUMENT unless the sides are 1 to 16384 pixels, or if the transfer function is
///   invalid; LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY. After an error the picture is unchanged.
/// - Untrusted input: any bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_picture_draw_bar(
    colours: *mut u8,
    width: u32,
    height: u32,
    title: *const c_char,
    title_length: usize,
    transfer: *const leafless_transfer,
    side: Number<leafless_legend_side>,
    covered: *mut leafless_legend_box,
) -> leafless_status {
    guard(|| unsafe {
        let title = text(title, title_length, "title")?;
        shared(transfer, "transfer")?;
        let transfer = sized(transfer, "transfer")?.check()?;
        let side = side.known("side")?;
        let covered = out(covered, "covered")?;
        let colour = |value: f64| transfer.opaque(Some([value, 0.0, 0.0, 0.0]), 1);
        drawn(colours, [width, height], covered, |picture| {
            Ok(draw_colour_bar(picture, title, transfer.range(), &colour, side)?)
        })
    })
}

/// A colour with its meaning in a legend.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_legend_name {
    /// The name in UTF-8; need not be NUL-terminated.
    pub name: *const c_char,
    /// Length of the name in bytes.
    pub name_length: usize,
    /// Red, green, blue (sRGB) and opacity.
    pub colour: [u8; 4],
    /// Reserved; 0.
    pub reserved: u32,
}

/// Draws boxes of colours with their names into a picture, under a title, on a light panel. Names that do not
/// fit are left out or cut.
///
/// - Buffers: `colours`, `title`, `side` and `covered` as leafless_picture_draw_bar; `names`, `name_count`
///   structs.
/// - Result: as leafless_picture_draw_bar; there is also no legend if there is neither a title nor a name.
/// - Errors: as leafless_picture_draw_bar.
/// - Untrusted input: any bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_picture_draw_names(
    colours: *mut u8,
    width: u32,
    height: u32,
    title: *const c_char,
    title_length: usize,
    names: *const leafless_legend_name,
    name_count: u64,
    side: Number<leafless_legend_side>,
    covered: *mut leafless_legend_box,
) -> leafless_status {
    guard(|| unsafe {
        let title = text(title, title_length, "title")?;
        let given = slice(names, name_count, "names")?;
        let mut names = memory::with_capacity(given.len())?;
        for given in given {
            if given.reserved != 0 {
                return Err(Failure::Argument { name: "names.reserved", problem: "must be 0" });
            }
            names.push((text(given.name, given.name_length, "names.name")?, given.colour));
        }
        let side = side.known("side")?;
        let covered = out(covered, "covered")?;
        drawn(colours, [width, height], covered, |picture| Ok(draw_names(picture, title, &names, side)))
    })
}
