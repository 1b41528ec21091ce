//! Generates `include/leafless.hpp` from `include/leafless.h`. Every function of the C interface becomes a
//! member of a class or a function, by the rules at the top of the generated file.

use crate::header::{Function, Header, Parameter};
use crate::refused::may_be_null;
use std::fmt::Write;

/// Arrays whose elements have several numbers: the function (empty for all), the parameter, and the number.
const DIMENSIONS: &[(&str, &str, usize)] = &[
    ("leafless_layer_new_lines", "points_model", 6),
    ("leafless_tridexel_voxels", "colours", 4),
    ("leafless_mesh_copy", "vertices", 3),
    ("leafless_mesh_copy", "triangles", 3),
    ("leafless_mesh_normals", "normals", 3),
    ("leafless_tridexel_copy_cells", "ends_cells", 2),
    ("", "points_model", 3),
    ("", "planes", 4),
    ("", "polygon_model", 2),
    ("", "matrices", 12),
];

/// Functions with several optional arrays. Their parameters are those of C.
const AS_IN_C: &[&str] = &["leafless_tridexel_copy", "leafless_octree_voxels", "leafless_voxels_moved"];

/// Functions whose answers have several numbers each, and the statement that counts these numbers.
const VALUES: &[(&str, &str)] = &[
    ("leafless_attribute_values", "const std::size_t components = detail::components_of(get());"),
    ("leafless_channel_values", "const std::size_t components = detail::components_of(get());"),
];

/// Pointers that may be NULL in C and that the interface for C++ requires.
const REQUIRED: &[(&str, &str)] = &[
    ("leafless_mesh_read", "options"),
    ("leafless_mesh_write", "options"),
    ("leafless_mesh_write_polygons", "options"),
    ("leafless_volume_read", "data"),
    ("leafless_scene_read", "options"),
    ("leafless_channel_summarise", "min_model"),
    ("leafless_channel_summarise", "max_model"),
];

impl Parameter {
    /// True for `const T *name`.
    fn is_input(&self) -> bool {
        self.is_const && self.pointers == 1 && self.array.is_none()
    }

    /// True for `T *name`.
    fn is_output(&self) -> bool {
        !self.is_const && self.pointers == 1 && self.array.is_none()
    }

    /// True for an output that counts elements.
    fn is_count(&self) -> bool {
        self.is_output() && (self.name.ends_with("count") || self.name.ends_with("length"))
    }

    fn is(&self, base: &str, pointers: usize) -> bool {
        self.base == base && self.pointers == pointers && self.array.is_none()
    }

    /// The type of an element of an array.
    fn element(&self) -> String {
        let base = if self.base == "void" { "std::byte" } else { &self.base };
        if self.dimension == 1 { base.to_string() } else { array_of(base, self.dimension) }
    }

    /// The type of an array of fixed length.
    fn fixed(&self) -> String {
        array_of(&self.base, self.array.expect("a number"))
    }

    /// The declaration in C.
    fn in_c(&self) -> String {
        let qualifier = if self.is_const { "const " } else { "" };
        let stars = "*".repeat(self.pointers + usize::from(self.array.is_some()));
        format!("{qualifier}{} {stars}{}", self.base, self.name)
    }
}

/// Returns the type of an array of `count` elements. Some have names.
fn array_of(base: &str, count: usize) -> String {
    match (base, count) {
        ("double", 3) => "point".to_string(),
        ("double", 12) => "affine".to_string(),
        ("uint32_t", 3) => "cell_index".to_string(),
        ("uint32_t", 2) => "ray_index".to_string(),
        // (Without a space, at which lines would be broken.)
        _ => format!("std::array<{base},{count}>"),
    }
}

/// A function in C++ under construction.
#[derive(Default)]
struct Translation {
    /// Parameters, each with its default if it has one.
    parameters: Vec<(String, Option<&'static str>)>,
    /// The arguments of the C function, in its order.
    arguments: Vec<String>,
    /// Statements before the call.
    before: Vec<String>,
    /// Statements between the first call, which queries sizes, and the second.
    sizes: Vec<String>,
    /// Arguments of the first call that differ, by their indices.
    first: Vec<(usize, String)>,
    /// Types and values of the results.
    results: Vec<(String, String)>,
    is_const: bool,
    has_self: bool,
}

struct Translator<'a> {
    handles: Vec<String>,
    /// The structs that begin with their size.
    sized: Vec<&'a str>,
}

impl Translator<'_> {
    /// Returns the class of a function and the function's name there, if it has a class.
    fn class_of<'f>(&self, name: &'f str) -> Option<(&str, &'f str)> {
        let rest = name.strip_prefix("leafless_").expect("a prefix");
        let fitting = self
            .handles
            .iter()
            .filter(|class| rest.strip_prefix(class.as_str()).is_some_and(|r| r.starts_with('_')));
        let class = fitting.max_by_key(|class| class.len())?;
        Some((class, &rest[class.len() + 1..]))
    }

    fn is_handle(&self, base: &str) -> bool {
        base.strip_prefix("leafless_").is_some_and(|name| self.handles.iter().any(|handle| handle == name))
    }

    fn translate(&self, function: &Function) -> Translation {
        let class = self.class_of(&function.name).map(|(class, _)| class);
        let list = &function.parameters;
        let mut made = Translation::default();
        // The name of the span that has one element for each question.
        let mut asked: Option<&str> = None;
        let mut i = 0;
        while let Some(p) = list.get(i) {
            let next = |k: usize| list.get(i + k);
            let (name, base) = (p.name.as_str(), p.base.as_str());
            // (The two corners of a rectangle of rays are both NULL or both not.)
            let is_corner = p.is_const && p.array == Some(2);
            let is_required = REQUIRED.contains(&(function.name.as_str(), name));
            let may_be_null = is_corner || !is_required && may_be_null(function, i).is_some();
            if i == 0 && p.pointers == 1 && class.is_some_and(|class| base == format!("leafless_{class}")) {
                made.has_self = true;
                made.is_const = p.is_const;
                made.arguments.push("get()".to_string());
                i += 1;
            } else if AS_IN_C.contains(&function.name.as_str()) {
                made.parameters.push((p.in_c(), None));
                made.arguments.push(name.to_string());
                i += 1;
            } else if name == "colours" && next(1).is_some_and(|width| width.name == "width") {
                // A picture: four bytes a pixel.
                let qualifier = if p.is_const { "const " } else { "" };
                made.parameters.push((format!("span<{qualifier}{base}> {name}"), None));
                made.before
                    .push(format!("detail::at_least(std::size_t{{4}} * width * height, {name}.size());"));
                made.arguments.push(format!("{name}.data()"));
                i += 1;
            } else if p.is_output()
                && next(1).is_some_and(|capacity| capacity.name.ends_with("capacity"))
                && (function.name.ends_with("_next") || !next(2).is_some_and(Parameter::is_count))
            {
                // Filled as far as there is room.
                made.parameters.push((format!("span<{}> {name}", p.element()), None));
                made.arguments.push(pointer_to(p));
                made.arguments.push(format!("{name}.size()"));
                i += 2;
            } else if p.is("char", 1)
                && p.is_const
                && next(1).is_some_and(|length| length.name == format!("{name}_length"))
            {
                made.parameters.push((format!("std::string_view {name}"), None));
                made.arguments.push(format!("{name}.data()"));
                made.arguments.push(format!("{name}.size()"));
                i += 2;
            } else if p.is("char", 2) && next(1).is_some_and(|length| length.name == format!("{name}_length"))
            {
                made.before.push(format!("const char *{name} = nullptr;"));
                made.before.push(format!("std::size_t {name}_length = 0;"));
                made.arguments.push(format!("&{name}"));
                made.arguments.push(format!("&{name}_length"));
                made.results
                    .push(("std::string_view".to_string(), format!("detail::text({name}, {name}_length)")));
                i += 2;
            } else if self.is_handle(base) && p.pointers == 2 && !p.is_const {
                let class = base.strip_prefix("leafless_").expect("a prefix");
                let handle = format!("{name}_handle");
                made.before.push(format!("{base} *{handle} = nullptr;"));
                made.arguments.push(format!("&{handle}"));
                made.results.push((format!("leafless::{class}"), format!("leafless::{class}({handle})")));
                i += 1;
            } else if self.is_handle(base)
                && p.pointers == 2
                && next(1).is_some_and(|count| count.name.ends_with("count"))
            {
                made.parameters.push((format!("span<const {base} *const> {name}"), None));
                made.arguments.push(format!("{name}.data()"));
                made.arguments.push(format!("{name}.size()"));
                i += 2;
            } else if self.is_handle(base) && p.pointers == 1 {
                let class = base.strip_prefix("leafless_").expect("a prefix");
                if may_be_null {
                    made.parameters.push((format!("const leafless::{class} *{name}"), Some("nullptr")));
                    made.arguments.push(format!("detail::handle_of({name})"));
                } else {
                    let qualifier = if p.is_const { "const " } else { "" };
                    made.parameters.push((format!("{qualifier}leafless::{class} &{name}"), None));
                    made.arguments.push(format!("{name}.get()"));
                }
                i += 1;
            } else if let Some(arrays) = self.arrays_in(&list[i..]) {
                for array in &list[i..i + arrays] {
                    let element = match self.is_handle(&array.base) {
                        true => format!("{} *const", array.base),
                        false => array.element(),
                    };
                    made.parameters.push((format!("span<const {element}> {}", array.name), None));
                    made.arguments.push(pointer_to(array));
                    if array.name != p.name {
                        made.before.push(format!("detail::same_size({name}.size(), {}.size());", array.name));
                    }
                }
                made.arguments.push(format!("{name}.size()"));
                asked = Some(name);
                i += arrays + 1;
            } else if let Some((buffers, count)) = self.two_steps(&list[i..]) {
                // T *a, [T *b,] uint64_t capacity, uint64_t *count
                let counter = &list[i + buffers + 1].name;
                made.before.push(format!("std::uint64_t {counter} = 0;"));
                for buffer in &list[i..i + buffers] {
                    let element = buffer.element();
                    made.before.push(format!("std::vector<{element}> {};", buffer.name));
                    made.sizes.push(format!("{}.resize(static_cast<std::size_t>({counter}));", buffer.name));
                    made.first.push((made.arguments.len(), "nullptr".to_string()));
                    made.arguments.push(pointer_to(buffer));
                    made.results
                        .push((format!("std::vector<{element}>"), format!("std::move({})", buffer.name)));
                }
                made.first.push((made.arguments.len(), "0".to_string()));
                made.arguments.push(format!("{}.size()", list[i].name));
                made.arguments.push(format!("&{counter}"));
                i += count;
            } else if p.array.is_some() && p.is_const {
                if may_be_null {
                    made.parameters.push((format!("const {} *{name}", p.fixed()), Some("nullptr")));
                    made.arguments.push(format!("{name} == nullptr ? nullptr : {name}->data()"));
                } else {
                    made.parameters.push((format!("const {} &{name}", p.fixed()), None));
                    made.arguments.push(format!("{name}.data()"));
                }
                i += 1;
            } else if p.array.is_some() {
                made.before.push(format!("{} {name}{{}};", p.fixed()));
                made.arguments.push(format!("{name}.data()"));
                made.results.push((p.fixed(), name.to_string()));
                i += 1;
            } else if p.is_input() && base.starts_with("leafless_") {
                if may_be_null {
                    made.parameters.push((format!("const {base} *{name}"), Some("nullptr")));
                    made.arguments.push(name.to_string());
                } else {
                    made.parameters.push((format!("const {base} &{name}"), None));
                    made.arguments.push(format!("&{name}"));
                }
                i += 1;
            } else if p.is_output() && asked.is_some() && is_plural(name) && base != "void" {
                // One answer for each query, in the caller's buffer if there is one.
                made.parameters.push((format!("span<{}> {name}", p.element()), None));
                let asked = asked.expect("questions");
                match VALUES.iter().find(|(of, _)| *of == function.name) {
                    Some((_, components)) => {
                        made.before.push((*components).to_string());
                        made.before
                            .push(format!("detail::at_least({asked}.size() * components, {name}.size());"));
                    }
                    None => made.before.push(format!("detail::same_size({asked}.size(), {name}.size());")),
                }
                made.arguments.push(format!("{name}.data()"));
                i += 1;
            } else if p.is_output()
                && base != "void"
                && next(1).is_none_or(|next| !next.name.ends_with("capacity"))
            {
                made.before.push(match self.sized.contains(&base) {
                    true => format!("{base} {name} = LEAFLESS_INIT({base});"),
                    false => format!("{base} {name}{{}};"),
                });
                made.arguments.push(format!("&{name}"));
                made.results.push((base.to_string(), name.to_string()));
                i += 1;
            } else {
                // As in C.
                made.parameters.push((p.in_c(), None));
                made.arguments.push(name.to_string());
                i += 1;
            }
        }
        // Only the last parameters may have defaults.
        let last = made.parameters.iter().rposition(|(_, default)| default.is_none()).map_or(0, |at| at + 1);
        made.parameters[..last].iter_mut().for_each(|(_, default)| *default = None);
        made
    }

    /// Returns the number of arrays of numbers, structs or objects that begin here and share one count.
    fn arrays_in(&self, list: &[Parameter]) -> Option<usize> {
        let is_array = |p: &Parameter| match self.is_handle(&p.base) {
            true => p.is_const && p.pointers == 2,
            false => p.is_input(),
        };
        let count = list.iter().take_while(|p| is_array(p)).count();
        let counter = list.get(count).filter(|_| count > 0)?;
        let is_counter = counter.pointers == 0
            && (counter.name.ends_with("count") || counter.name.ends_with("length"))
            && counter.base == "uint64_t";
        // A struct before numbers belongs to something else.
        let is_struct = |p: &Parameter| p.base.starts_with("leafless_") && !self.is_handle(&p.base);
        let is_one = count == 1 || !list[..count].iter().any(is_struct);
        (is_counter && is_one).then_some(count)
    }

    /// If buffers begin here that are filled in two steps, returns how many buffers and how many parameters.
    fn two_steps(&self, list: &[Parameter]) -> Option<(usize, usize)> {
        let buffers = list.iter().take_while(|p| p.is_output() && p.base != "bool").count();
        let [capacity, count] = list.get(buffers..buffers + 2)? else { return None };
        let is_capacity = capacity.pointers == 0 && capacity.name.ends_with("capacity");
        let is_so = buffers > 0 && is_capacity && count.is_count();
        // Buffers of one capacity have one kind of elements.
        let is_alike = |p: &Parameter| p.base == list[0].base && p.dimension == 1;
        assert!(!is_so || buffers == 1 || list[..buffers].iter().all(is_alike), "{list:?}");
        is_so.then_some((buffers, buffers + 2))
    }
}

/// True if an output of this name has one element for each question.
fn is_plural(name: &str) -> bool {
    let name = name.trim_end_matches("_model");
    name.ends_with('s') && !["bytes", "cells"].contains(&name)
}

/// Returns the pointer to the first number of an array.
fn pointer_to(array: &Parameter) -> String {
    let name = &array.name;
    match array.dimension {
        1 => format!("{name}.data()"),
        _ => format!("detail::numbers({name})"),
    }
}

fn returned(made: &Translation) -> String {
    match made.results.as_slice() {
        [] => "void".to_string(),
        [(kind, _)] => kind.clone(),
        several => {
            let kinds: Vec<&str> = several.iter().map(|(kind, _)| kind.as_str()).collect();
            format!("std::tuple<{}>", kinds.join(", "))
        }
    }
}

/// Returns a name that is legal in C++ for a member.
fn spelled(name: &str) -> &str {
    match name {
        "new" => "make",
        "union" => "unite",
        other => other,
    }
}

/// Returns the structs of the header that begin with their size.
fn sized(header: &str) -> Vec<&str> {
    let structs = header.split("typedef struct ").filter_map(|text| text.split_once(" {\n"));
    structs.filter(|(_, body)| body.starts_with("    uint32_t struct_size;")).map(|(name, _)| name).collect()
}

/// Returns the declarations of classes, and their bodies.
pub fn made_of(header: &str) -> String {
    let mut functions = Header::read(header).functions;
    for function in &mut functions {
        for p in &mut function.parameters {
            let mut known = DIMENSIONS.iter().filter(|(of, ..)| of.is_empty() || *of == function.name);
            p.dimension = known.find(|(_, name, _)| *name == p.name).map_or(1, |&(.., dimension)| dimension);
        }
    }
    let names = |suffix: &str| -> Vec<String> {
        let fitting = functions.iter().filter_map(|f| f.name.strip_prefix("leafless_")?.strip_suffix(suffix));
        fitting.map(str::to_string).collect()
    };
    let translator = Translator { handles: names("_free"), sized: sized(header) };
    let (mut classes, mut bodies, mut free) = (String::new(), String::new(), String::new());
    for class in &translator.handles {
        writeln!(classes, "class {class};").expect("memory");
    }
    for class in &translator.handles {
        let handle = format!("leafless_{class}");
        write!(
            classes,
            "\n/// A {handle}.\nclass {class} : public detail::owner<{handle}, {handle}_free> {{\npublic:\n    using owner::owner;\n"
        )
        .expect("memory");
        for function in
            functions.iter().filter(|f| translator.class_of(&f.name).is_some_and(|(of, _)| of == class))
        {
            let (_, name) = translator.class_of(&function.name).expect("a class");
            if name == "free" {
                continue;
            }
            let made = translator.translate(function);
            let name = if name == "ref" { "share" } else { spelled(name) };
            write_function(&made, function, Some(class), name, &mut classes, &mut bodies);
        }
        classes.push_str("};\n");
    }
    for function in functions.iter().filter(|f| translator.class_of(&f.name).is_none()) {
        let name = function.name.strip_prefix("leafless_").expect("a prefix");
        if ["last_error", "last_status", "last_code", "init"].contains(&name) {
            continue;
        }
        let made = translator.translate(function);
        write_function(&made, function, None, spelled(name), &mut free, &mut bodies);
    }
    format!("\n{classes}\n{free}{bodies}")
}

fn write_function(
    made: &Translation,
    function: &Function,
    class: Option<&str>,
    name: &str,
    declarations: &mut String,
    bodies: &mut String,
) {
    let is_fallible = function.result == "leafless_status";
    let result = if is_fallible { format!("returns<{}>", returned(made)) } else { function.result.clone() };
    let parameters = |with_defaults: bool| {
        let list = made.parameters.iter().map(|(text, default)| match default {
            Some(default) if with_defaults => format!("{text} = {default}"),
            _ => text.clone(),
        });
        list.collect::<Vec<_>>().join(", ")
    };
    let space = if result.ends_with('*') { "" } else { " " };
    let qualifier = if class.is_some() && made.has_self && made.is_const { " const" } else { "" };
    let is_static = if class.is_some() && !made.has_self { "static " } else { "" };
    // A function that changes its object may be called for this effect alone.
    let changes = made.has_self && !made.is_const;
    let discards = if changes || returned(made) == "void" && is_fallible { "" } else { "[[nodiscard]] " };
    let indent = if class.is_some() { "    " } else { "" };
    let declaration =
        format!("{indent}{discards}{is_static}{result}{space}{name}({}){qualifier};", parameters(true));
    declarations.push_str(&wrapped(&declaration, indent.len() + 4));

    let scope = class.map_or(String::new(), |class| format!("{class}::"));
    let head = format!("inline {result}{space}{scope}{name}({}){qualifier} {{", parameters(false));
    bodies.push('\n');
    bodies.push_str(&wrapped(&head, 4));
    for line in &made.before {
        bodies.push_str(&wrapped(&format!("    {line}"), 8));
    }
    let call = |arguments: &[String]| format!("{}({})", function.name, arguments.join(", "));
    if !is_fallible {
        bodies.push_str(&wrapped(&format!("    return {};", call(&made.arguments)), 8));
        bodies.push_str("}\n");
        return;
    }
    let value = match made.results.as_slice() {
        [] => String::new(),
        [(_, value)] => format!(", {value}"),
        several => {
            let values: Vec<&str> = several.iter().map(|(_, value)| value.as_str()).collect();
            format!(", {}({})", returned(made), values.join(", "))
        }
    };
    if made.first.is_empty() {
        bodies
            .push_str(&wrapped(&format!("    const leafless_status status = {};", call(&made.arguments)), 8));
    } else {
        let mut first = made.arguments.clone();
        for (at, argument) in &made.first {
            first[*at].clone_from(argument);
        }
        bodies.push_str(&wrapped(&format!("    leafless_status status = {};", call(&first)), 8));
        bodies.push_str("    if (status == LEAFLESS_OK) {\n");
        for line in &made.sizes {
            writeln!(bodies, "        {line}").expect("memory");
        }
        bodies.push_str(&wrapped(&format!("        status = {};", call(&made.arguments)), 12));
        bodies.push_str("    }\n");
    }
    bodies.push_str(&wrapped(&format!("    return detail::finish(status{value});"), 8));
    bodies.push_str("}\n");
}

/// Breaks a long line behind commas.
fn wrapped(text: &str, indent: usize) -> String {
    let mut out = String::new();
    let mut line = String::new();
    for word in text.split_inclusive(", ") {
        if !line.trim().is_empty() && line.chars().count() + word.trim_end().chars().count() > 110 {
            writeln!(out, "{}", line.trim_end()).expect("memory");
            line = " ".repeat(indent);
        }
        line.push_str(word);
    }
    writeln!(out, "{}", line.trim_end()).expect("memory");
    out
}
