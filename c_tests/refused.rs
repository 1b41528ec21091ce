//! Generates a program from `include/leafless.h`. It calls every function with each parameter wrong: with
//! pointers that are NULL or misaligned, and with numbers out of range. Each of these calls returns a status
//! and a message that names the parameter, and writes no result. Calls with valid arguments succeed.
//!
//! `refused.c` has the valid objects and structs. `refused.txt` has the other facts. If both lack a parameter
//! of a new function, the test fails and says what to add.

use crate::header::{Enumeration, Function, Header, Parameter};
use crate::kit::kit;
use crate::{header, text};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::OnceLock;

/// Functions that return no status, beside those that end in `_free`.
const NO_STATUS: &[&str] =
    &["version", "version_string", "abi", "status_name", "last_error", "last_status", "last_code"];

/// A count and a capacity that no memory has room for.
const TOO_MANY: &str = "UINT64_MAX";

fn without_prefix(name: &str) -> &str {
    name.strip_prefix("leafless_").unwrap_or(name)
}

/// Returns the facts of a section of `refused.txt`. A fact is a key, such as a parameter, and a text.
fn section(title: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
    static FACTS: OnceLock<Vec<(String, String, String)>> = OnceLock::new();
    let facts = FACTS.get_or_init(|| {
        let mut facts = Vec::new();
        // A line that is indented continues the line before it.
        let lines = text("c_tests/refused.txt").replace("\n    ", " ");
        let mut title = "";
        for line in lines.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
            if let Some(next) = line.strip_prefix("== ") {
                title = next;
                continue;
            }
            let (keys, values) = line.split_once(':').unwrap_or((line, ""));
            for (key, value) in
                keys.split(", ").flat_map(|key| values.split(" | ").map(move |value| (key, value)))
            {
                facts.push((title.to_string(), key.to_string(), value.trim().to_string()));
            }
        }
        facts
    });
    let own: Vec<_> = facts.iter().filter(|(section, ..)| section == title).collect();
    own.into_iter().map(|(_, key, value)| (key.as_str(), value.as_str()))
}

/// If a pointer may be NULL, returns the other arguments that this requires.
pub fn may_be_null(function: &Function, at: usize) -> Option<Changes> {
    let p = &function.parameters[at];
    let key = format!("{}.{}", without_prefix(&function.name), p.name);
    if let Some((_, changes)) = section("null").find(|(known, _)| *known == key) {
        return Some(parse_changes(changes));
    }
    if p.base == "leafless_options" {
        return Some(Changes::new());
    }
    // All buffers of one capacity are absent together.
    let (buffers, capacity) = buffers(function, at)?;
    let mut changes: Changes = buffers
        .iter()
        .filter(|&&i| i != at)
        .map(|&i| (function.parameters[i].name.clone(), "NULL".into()))
        .collect();
    changes.push((function.parameters[capacity].name.clone(), "0".into()));
    Some(changes)
}

/// Other arguments of a call: names of parameters, and their values.
type Changes = Vec<(String, String)>;

fn parse_changes(text: &str) -> Changes {
    let pairs = text.split_whitespace().map(|word| word.split_once('=').expect("parameter=value"));
    pairs.map(|(name, value)| (name.to_string(), value.to_string())).collect()
}

/// If a parameter is a buffer with a capacity, returns all buffers of the capacity, and the capacity.
fn buffers(function: &Function, at: usize) -> Option<(Vec<usize>, usize)> {
    let list = &function.parameters;
    let is_buffer = |p: &Parameter| {
        let is_one = p.name.ends_with("count") || p.name.ends_with("length") || p.base == "leafless_frame";
        p.pointers == 1 && !p.is_const && !is_one && !p.base.ends_with("_info")
    };
    let capacity = at + list[at..].iter().position(|p| !is_buffer(p))?;
    // The first parameter of such a function is an object that it reads or changes.
    (at > 0 && list[capacity].pointers == 0 && list[capacity].name.ends_with("capacity") && capacity > at)
        .then(|| {
            let first = list[1..capacity].iter().rposition(|p| !is_buffer(p)).map_or(1, |before| before + 2);
            ((first..capacity).collect(), capacity)
        })
}

/// Wrong values, the other arguments that they need, and the status and the word of the refusal.
struct Wrong {
    values: String,
    besides: Changes,
    status: &'static str,
    word: String,
}

impl Wrong {
    fn parse(text: &'static str) -> Wrong {
        let (values, message) = text.split_once(" -> ").unwrap_or((text, ""));
        let (values, besides) = values.split_once(" with ").unwrap_or((values, ""));
        let (status, word) = match message.starts_with("E_") {
            true => message.split_once(' ').unwrap_or((message, "")),
            false => ("E_ARGUMENT", message),
        };
        Wrong { values: values.to_string(), besides: parse_changes(besides), status, word: word.to_string() }
    }

    /// Returns what the message says about a parameter. A word that begins with a sign follows its name.
    fn says(&self, parameter: &str) -> String {
        match self.word.chars().next() {
            None => parameter.to_string(),
            Some('.' | ':') => format!("{parameter}{}", self.word),
            Some(_) => self.word.clone(),
        }
    }
}

/// The program, and the list of all that it tries.
pub struct Program {
    /// Declarations of the structs that the functions read.
    pub structs: String,
    pub calls: String,
    /// Each entry is a function, a parameter, the word of the message, and what is wrong.
    pub tried: BTreeSet<String>,
}

/// Adds a line to the program.
macro_rules! line {
    ($generator:expr, $($text:tt)*) => {
        writeln!($generator.calls, "    {}", format_args!($($text)*)).expect("memory")
    };
}

struct Generator<'h> {
    header: &'h Header,
    /// The types of objects, without their prefix, in the order in which they are made.
    handles: Vec<&'h str>,
    /// The text of `refused.c`.
    maker: &'h str,
    calls: String,
    tried: BTreeSet<String>,
    problems: Vec<String>,
    used: BTreeSet<&'static str>,
}

/// Returns the program, or says what `refused.txt` and `refused.c` lack.
pub fn program(header: &Header, maker: &str) -> Result<Program, String> {
    let freed: BTreeSet<&str> = header
        .functions
        .iter()
        .filter_map(|function| without_prefix(&function.name).strip_suffix("_free"))
        .collect();
    let made = maker.lines().filter_map(|line| line.strip_prefix("HANDLE(")?.split(',').next());
    let handles: Vec<&str> = made.filter(|name| freed.contains(name)).collect();
    let mut generator = Generator {
        header,
        handles,
        maker,
        calls: String::new(),
        tried: BTreeSet::new(),
        problems: Vec::new(),
        used: BTreeSet::new(),
    };
    for handle in &freed {
        if !generator.handles.contains(handle) {
            generator.problems.push(format!("refused.c: add HANDLE({handle}, a call that makes one)"));
        }
    }
    let structs = generator.structs();
    for function in &header.functions {
        generator.function(function);
    }
    generator.finish();
    let keys = ["valid", "null", "numbers", "fields", "changed"].into_iter().flat_map(section);
    for (key, _) in keys {
        if !generator.used.contains(key) {
            generator.problems.push(format!("refused.txt: nothing is called {key}"));
        }
    }
    match generator.problems.is_empty() {
        true => Ok(Program { structs, calls: generator.calls, tried: generator.tried }),
        false => Err(generator.problems.join("\n")),
    }
}

impl Generator<'_> {
    /// Returns the texts of a key.
    fn exact(&mut self, title: &str, wanted: &str) -> Vec<&'static str> {
        let found: Vec<_> = section(title).filter(|(key, _)| *key == wanted).collect();
        self.used.extend(found.first().map(|(key, _)| *key));
        found.into_iter().map(|(_, value)| value).collect()
    }

    /// Returns the texts for a parameter of a function, or if there is none, those for its name.
    fn rows(&mut self, title: &str, function: &str, name: &str) -> Vec<&'static str> {
        let own = self.exact(title, &format!("{function}.{name}"));
        if own.is_empty() { self.exact(title, name) } else { own }
    }

    fn fields(&self, name: &str) -> Option<&[Parameter]> {
        let found = self.header.structs.iter().find(|(known, _)| known == name);
        found.map(|(_, fields)| fields.as_slice())
    }

    fn is_sized(&self, name: &str) -> bool {
        self.fields(name).is_some_and(|fields| fields[0].name == "struct_size")
    }

    fn is_handle(&self, base: &str) -> bool {
        self.handles.contains(&without_prefix(base))
    }

    /// True for a pointer to something that the function writes.
    fn is_output(&self, p: &Parameter) -> bool {
        let is_object = self.is_handle(&p.base) && p.pointers == 1;
        let is_pointer = p.pointers > 0 || p.array.is_some();
        // `const char **` receives a text. `const T *const *` is a list of objects.
        let is_written = !p.is_const || p.pointers == 2 && !self.is_handle(&p.base);
        is_pointer && !is_object && is_written
    }

    /// Returns whether a pointer can be misaligned.
    fn is_aligned(&self, p: &Parameter) -> bool {
        let enumeration = self.header.enumerations.iter().find(|one| one.name == p.base);
        let integer = enumeration.map_or(p.base.as_str(), |one| &one.integer);
        // `leafless_init` gets a struct by `void *`.
        let is_struct = integer == "void" && !p.is_const;
        p.pointers > 1 || is_struct || !["uint8_t", "char", "bool", "void"].contains(&integer)
    }

    /// Declares the structs that functions read and that begin with their size.
    fn structs(&mut self) -> String {
        let mut read = BTreeSet::new();
        for p in self.header.functions.iter().flat_map(|function| &function.parameters) {
            if p.is_const && p.pointers == 1 && self.is_sized(&p.base) {
                read.insert(p.base.as_str());
            }
        }
        let mut text = String::new();
        for name in &read {
            writeln!(text, "static {name} {};", without_prefix(name)).expect("memory");
        }
        text.push_str("\nstatic void init_structs(void) {\n");
        for name in &read {
            let variable = without_prefix(name);
            writeln!(text, "    OK(leafless_init(&{variable}, sizeof {variable}));").expect("memory");
        }
        text.push_str("}\n");
        text
    }

    /// Returns a valid argument.
    fn valid(&mut self, function: &Function, at: usize, outputs: &[usize]) -> String {
        let p = &function.parameters[at];
        let own = without_prefix(&function.name);
        let name = without_prefix(&p.base);
        if let Some(output) = outputs.iter().position(|&output| output == at) {
            return format!("at({output})");
        }
        if let [value, ..] = self.rows("valid", own, &p.name)[..] {
            return value.to_string();
        }
        if self.is_handle(&p.base) {
            return match p.pointers {
                1 => name.to_string(),
                _ => format!("(const {0} *const[]){{{name}, {name}}}", p.base),
            };
        }
        if self.maker.contains(&format!(" {}[", p.name)) {
            return p.name.clone();
        }
        let before = at.checked_sub(1).map(|before| &function.parameters[before]);
        if p.pointers == 1 && self.fields(&p.base).is_some() {
            let declared = [" = ", ";"].iter().any(|end| self.maker.contains(&format!(" {name}{end}")));
            if !declared && !self.is_sized(&p.base) {
                self.problems.push(format!("refused.c: add a valid `static {} {name}`", p.base));
            }
            return format!("&{name}");
        }
        if p.pointers == 0 && p.array.is_none() {
            if let Some(before) = before.filter(|_| p.name.ends_with("capacity")) {
                return format!("ROOM / 16 / sizeof({})", before.base);
            }
            if p.name.ends_with("count") && p.base == "uint64_t" {
                return if before.is_some_and(|list| list.pointers == 2) { "2" } else { "1" }.to_string();
            }
            if p.base == "bool" || self.header.enumerations.iter().any(|one| one.name == p.base) {
                return "0".to_string();
            }
            if p.name.ends_with("_length") {
                return "1".to_string();
            }
        }
        self.problems.push(format!(
            "refused.txt, valid: add `{}: ` or `{own}.{}: ` and a valid {}",
            p.name, p.name, p.base
        ));
        "0".to_string()
    }

    fn function(&mut self, function: &Function) {
        let own = without_prefix(&function.name).to_string();
        if let Some(object) = own.strip_suffix("_free") {
            writeln!(self.calls, "static void call_{own}(void) {{\n    leafless_{object}_free(NULL);\n}}\n")
                .expect("memory");
            self.tried.insert(format!("{own} {object} MAY_BE_NULL"));
            return;
        }
        if function.result != "leafless_status" {
            if !NO_STATUS.contains(&own.as_str()) {
                self.problems
                    .push(format!("refused.rs: {own} returns no status; add it to NO_STATUS if it may"));
            }
            return;
        }
        let outputs: Vec<usize> =
            (0..function.parameters.len()).filter(|&at| self.is_output(&function.parameters[at])).collect();
        let arguments: Vec<String> =
            (0..function.parameters.len()).map(|at| self.valid(function, at, &outputs)).collect();
        writeln!(self.calls, "static void call_{own}(void) {{").expect("memory");
        line!(self, "static const char F[] = \"{own}\";");
        line!(self, "begin({});", outputs.len());
        self.renew(function);
        for (output, &at) in outputs.iter().enumerate() {
            let p = &function.parameters[at];
            if self.is_sized(&p.base) && p.pointers == 1 {
                line!(self, "outputs[{output}].struct_size = sizeof({});", p.base);
            }
            if !self.exact("changed", &format!("{own}.{}", p.name)).is_empty() {
                line!(self, "outputs[{output}].may_change = true;");
            }
        }
        let call = Call { function, own: &own, outputs: &outputs, arguments };
        let has_operation = function.parameters.iter().any(|p| p.name == "operation");
        if has_operation {
            line!(self, "for (operation = 0; operation < 4; operation++) {{");
        }
        for at in 0..function.parameters.len() {
            let p = &function.parameters[at];
            if p.pointers > 0 || p.array.is_some() {
                self.pointer(&call, at);
            }
            if p.pointers == 1 && p.is_const && self.fields(&p.base).is_some() {
                self.fields_of(&call, at);
            } else if self.is_handle(&p.base) {
                self.objects(&call, at);
            } else if !self.is_output(p) {
                self.numbers(&call, at);
            }
        }
        self.baseline(&call);
        self.calls.push_str(if has_operation { "    }\n}\n\n" } else { "}\n\n" });
    }

    /// Tries a pointer that is NULL or misaligned, a list with such a pointer, and a result of a wrong size.
    fn pointer(&mut self, call: &Call<'_>, at: usize) {
        let p = &call.function.parameters[at];
        let nullable = may_be_null(call.function, at);
        self.exact("null", &format!("{}.{}", call.own, p.name));
        // A pointer that may be NULL only with other arguments is refused with the valid ones.
        let alone = nullable.as_ref().and_then(|changes| changes.iter().find(|(name, _)| name == "alone"));
        if let Some((_, status)) = alone {
            self.refused(call, status, "", "NULL_POINTER", &[(at, "NULL")]);
        } else if nullable.as_ref().is_none_or(|changes| !changes.is_empty()) {
            self.refused(call, "E_NULL", &p.name, "NULL_POINTER", &[(at, "NULL")]);
        }
        if self.is_aligned(p) {
            let wrong = format!("WRONG({})", call.arguments[at]);
            self.refused(call, "E_ARGUMENT", &p.name, "MISALIGNED", &[(at, &wrong)]);
        }
        if self.is_handle(&p.base) && p.pointers == 2 && p.is_const {
            let (name, kind) = (without_prefix(&p.base), &p.base);
            for (status, what, wrong) in [
                ("E_NULL", "NULL_POINTER", "NULL".to_string()),
                ("E_ARGUMENT", "MISALIGNED", format!("WRONG({name})")),
            ] {
                for list in [format!("{name}, {wrong}"), format!("{wrong}, {name}")] {
                    let list = format!("(const {kind} *const[]){{{list}}}");
                    let mut changes = vec![(at, list.as_str())];
                    let count = call
                        .function
                        .parameters
                        .iter()
                        .position(|p| p.name == "count" || p.name == "layer_count");
                    changes.extend(count.map(|count| (count, "2")));
                    self.refused(call, status, &p.name, what, &changes);
                }
            }
        }
        if self.is_output(p) && self.is_sized(&p.base) && p.pointers == 1 {
            let output = call.outputs.iter().position(|&output| output == at).expect("an output");
            for size in ["0", "3", "5000"] {
                line!(self, "outputs[{output}].struct_size = {size};");
                self.refused(call, "E_ARGUMENT", &p.name, "BAD_NUMBER", &[]);
            }
            line!(self, "outputs[{output}].struct_size = sizeof({});", p.base);
        }
    }

    /// Tries objects that a function refuses.
    fn objects(&mut self, call: &Call<'_>, at: usize) {
        for row in self.exact("numbers", &format!("{}.{}", call.own, call.function.parameters[at].name)) {
            let wrong = Wrong::parse(row);
            self.refused(call, wrong.status, &wrong.word, "BAD_NUMBER", &[(at, &wrong.values)]);
        }
    }

    /// Tries numbers out of range: of one parameter, or of each element of an array.
    fn numbers(&mut self, call: &Call<'_>, at: usize) {
        let p = &call.function.parameters[at];
        if p.base == "char" {
            return;
        }
        let rows = self.rows("numbers", call.own, &p.name);
        let enumeration = self.header.enumerations.iter().find(|one| one.name == p.base);
        let is_number = p.pointers == 0 && p.array.is_none();
        if rows.is_empty() {
            if let Some(enumeration) = enumeration.filter(|_| is_number) {
                self.each(call, at, &unknown(enumeration), &p.name, "E_ARGUMENT", &[]);
            } else if let Some(before) = at.checked_sub(1).filter(|_| {
                is_number
                    && (p.name.ends_with("capacity")
                        || p.name.ends_with("count")
                        || p.name.ends_with("length"))
            }) {
                let first = match buffers(call.function, before) {
                    Some((buffers, _)) => buffers[0],
                    None => self.first_array(call.function, before),
                };
                let word = call.function.parameters[first].name.clone();
                self.each(call, at, TOO_MANY, &word, "E_ARGUMENT", &[]);
            } else if enumeration.is_none() && p.base != "bool" && (is_number || p.base != "uint8_t") {
                self.problems.push(format!(
                    "refused.txt, numbers: add `{}: ` or `{}.{}: ` and the {} out of range, or `any`",
                    p.name, call.own, p.name, p.base
                ));
            }
        }
        for row in rows.into_iter().filter(|row| *row != "any") {
            let wrong = Wrong::parse(row);
            let word = wrong.says(p.name.trim_end_matches("_model"));
            let besides: Vec<(usize, &str)> =
                wrong.besides.iter().map(|(name, value)| (call.place(name), value.as_str())).collect();
            if is_number {
                self.each(call, at, &wrong.values, &word, wrong.status, &besides);
                continue;
            }
            let whole = wrong.values.starts_with('{');
            let good = &call.arguments[at];
            line!(self, "{{");
            if whole {
                line!(self, "const {} bad[] = {};", p.base, wrong.values);
            } else {
                line!(self, "static const {} wrong[] = {{{}}};", p.base, list(&wrong.values));
                line!(self, "{} bad[COUNT({good})];", p.base);
                line!(self, "size_t i;\n    for (i = 0; i < COUNT(wrong) * COUNT(bad); i++) {{");
                line!(self, "memcpy(bad, {good}, sizeof bad);");
                line!(self, "bad[i % COUNT(bad)] = wrong[i / COUNT(bad)];");
            }
            let mut changes = vec![(at, "bad")];
            changes.extend(besides);
            self.refused(call, wrong.status, &word, "BAD_NUMBER", &changes);
            line!(self, "{}", if whole { "}" } else { "}}" });
        }
    }

    /// Returns the first of the arrays of one count that end here.
    fn first_array(&self, function: &Function, last: usize) -> usize {
        let is_array = |p: &Parameter| {
            let is_list = self.is_handle(&p.base) && p.pointers == 2;
            p.is_const
                && p.pointers > 0
                && (is_list || self.fields(&p.base).is_none() && !self.is_handle(&p.base))
        };
        (0..last).rev().take_while(|&at| is_array(&function.parameters[at])).last().unwrap_or(last)
    }

    /// Tries a list of values for one number.
    fn each(
        &mut self,
        call: &Call<'_>,
        at: usize,
        values: &str,
        word: &str,
        status: &str,
        besides: &[(usize, &str)],
    ) {
        let base = &call.function.parameters[at].base;
        line!(self, "{{\n    static const {base} wrong[] = {{{}}};", list(values));
        line!(self, "size_t i;\n    for (i = 0; i < COUNT(wrong); i++) {{");
        let mut changes = vec![(at, "wrong[i]")];
        changes.extend(besides);
        self.refused(call, status, word, "BAD_NUMBER", &changes);
        line!(self, "}}\n    }}");
    }

    /// Tries wrong fields of a struct that a function reads.
    fn fields_of(&mut self, call: &Call<'_>, at: usize) {
        let p = &call.function.parameters[at];
        let kind = without_prefix(&p.base).to_string();
        let mut tries: Vec<(Wrong, String)> = Vec::new();
        for field in self.fields(&p.base).expect("fields").to_vec() {
            let name = &field.name;
            let own = self.exact("fields", &format!("{}.{}.{name}", call.own, p.name));
            let rows = if own.is_empty() { self.exact("fields", &format!("{kind}.{name}")) } else { own };
            let enumeration = self.header.enumerations.iter().find(|one| one.name == field.base);
            if !rows.is_empty() {
                for row in rows.into_iter().filter(|row| *row != "any") {
                    tries.push((Wrong::parse(row), name.clone()));
                }
                continue;
            }
            let (values, word) = if name == "struct_size" {
                ("0 3 5000".to_string(), ":".to_string())
            } else if name == "reserved" {
                ("1".to_string(), format!(".{name}"))
            } else if let Some(one) = enumeration.filter(|_| field.pointers == 0 && field.array.is_none()) {
                (unknown(one), format!(".{name}"))
            } else if field.pointers == 1 && field.base != "void" && self.is_aligned(&field) {
                let target = if self.is_handle(&field.base) { without_prefix(&field.base) } else { "values" };
                (format!("WRONG({target})"), format!(".{name}"))
            } else if field.base == "double" && field.pointers == 0 {
                self.problems.push(format!(
                    "refused.txt, fields: add `{kind}.{name}: ` and numbers out of range, or `any`"
                ));
                continue;
            } else {
                continue;
            };
            tries.push((Wrong { values, besides: Changes::new(), status: "E_ARGUMENT", word }, name.clone()));
        }
        for key in [kind, format!("{}.{}", call.own, p.name)] {
            tries
                .extend(self.exact("fields", &key).into_iter().map(|row| (Wrong::parse(row), String::new())));
        }
        for (wrong, field) in tries {
            self.field(call, at, &wrong, &field);
        }
    }

    fn field(&mut self, call: &Call<'_>, at: usize, wrong: &Wrong, field: &str) {
        let p = &call.function.parameters[at];
        let kinds = self.fields(&p.base).expect("fields");
        let known = kinds.iter().find(|known| known.name == field).cloned();
        let is_array = known.is_some_and(|known| known.array.is_some());
        let values = match wrong.values.contains(['=', ';']) {
            true => vec![wrong.values.as_str()],
            false => wrong.values.split_whitespace().collect(),
        };
        for value in values {
            line!(self, "{{\n    {} bad = *({});", p.base, call.arguments[at]);
            match (value.contains(['=', ';']), is_array) {
                (true, _) => line!(self, "{value}"),
                (false, true) => {
                    line!(self, "size_t i;\n    for (i = 0; i < COUNT(bad.{field}); i++) {{");
                    line!(self, "bad = *({});\n    bad.{field}[i] = {value};", call.arguments[at]);
                }
                (false, false) => line!(self, "bad.{field} = {value};"),
            }
            let word = wrong.says(&p.name);
            let what = match (wrong.status, value.contains("WRONG(")) {
                ("E_NULL", _) => "NULL_POINTER",
                (_, true) => "MISALIGNED",
                _ => "BAD_NUMBER",
            };
            let mut changes = vec![(at, "&bad")];
            changes.extend(wrong.besides.iter().map(|(name, value)| (call.place(name), value.as_str())));
            self.refused(call, wrong.status, &word, what, &changes);
            line!(self, "{}", if is_array && !value.contains('=') { "}}" } else { "}" });
        }
    }

    fn refused(&mut self, call: &Call<'_>, status: &str, word: &str, what: &str, changes: &[(usize, &str)]) {
        let text = call.with(changes);
        line!(self, "refused(LEAFLESS_{status}, F, \"{word}\", (prepare(), {text}));");
        let parameter = changes.first().map_or(word, |&(at, _)| &call.function.parameters[at].name);
        self.tried.insert(format!("{} {parameter} {word} {what}", call.own));
    }

    /// Makes the call with valid arguments, and one call without each pointer that may be NULL.
    fn baseline(&mut self, call: &Call<'_>) {
        self.succeeds(call, "with valid arguments", &[]);
        for at in 0..call.function.parameters.len() {
            let p = &call.function.parameters[at];
            if p.pointers == 0 && p.array.is_none() {
                continue;
            }
            if let Some(changes) = may_be_null(call.function, at) {
                let mut all = vec![(at, "NULL")];
                let changes = changes.iter().filter(|(name, _)| name != "alone");
                all.extend(changes.map(|(name, value)| (call.place(name), value.as_str())));
                self.succeeds(call, &format!("without {}", p.name), &all);
                self.tried.insert(format!("{} {} {} MAY_BE_NULL", call.own, p.name, p.name));
            }
        }
    }

    /// Makes new objects, if functions change objects of this type.
    fn renew(&mut self, function: &Function) {
        for p in &function.parameters {
            let changes = |f: &&Function| !f.name.ends_with("_free") && f.parameters[0].base == p.base;
            let mut changing =
                self.header.functions.iter().filter(|f| !f.parameters.is_empty()).filter(changes);
            let is_changed = changing.any(|f| !f.parameters[0].is_const && f.parameters[0].pointers == 1);
            if self.is_handle(&p.base) && p.pointers == 1 && is_changed {
                line!(self, "new_{}();", without_prefix(&p.base));
            }
        }
    }

    fn succeeds(&mut self, call: &Call<'_>, how: &str, changes: &[(usize, &str)]) {
        self.renew(call.function);
        let text = call.with(changes);
        let mut free = String::new();
        for (output, &at) in call.outputs.iter().enumerate() {
            let p = &call.function.parameters[at];
            let is_absent = changes.iter().any(|&(changed, _)| changed == at);
            if self.is_handle(&p.base) && !is_absent {
                write!(free, " {}_free(taken({output}));", p.base).expect("memory");
            }
        }
        line!(self, "if (accepted(F, \"{how}\", (prepare(), {text}))) {{{free} }}");
    }

    /// Adds the functions that make all objects, free all objects, and call all functions.
    fn finish(&mut self) {
        let status = |f: &&Function| f.result == "leafless_status" || f.name.ends_with("_free");
        let mut text = String::from("static void new_objects(void) {\n");
        for handle in &self.handles {
            writeln!(text, "    new_{handle}();").expect("memory");
        }
        text.push_str("}\n\nstatic void free_objects(void) {\n");
        for handle in self.handles.iter().rev() {
            writeln!(text, "    leafless_{handle}_free({handle});").expect("memory");
        }
        text.push_str("}\n\nstatic void call_all(void) {\n");
        for function in self.header.functions.iter().filter(status) {
            writeln!(text, "    call_{}();", without_prefix(&function.name)).expect("memory");
        }
        text.push_str("}\n");
        self.calls.push_str(&text);
    }
}

/// A call of a function, with valid arguments.
struct Call<'f> {
    function: &'f Function,
    own: &'f str,
    /// The parameters that the function writes to.
    outputs: &'f [usize],
    arguments: Vec<String>,
}

impl Call<'_> {
    fn place(&self, name: &str) -> usize {
        let found = self.function.parameters.iter().position(|p| p.name == name);
        found.unwrap_or_else(|| panic!("refused.txt: {} has no {name}", self.own))
    }

    fn with(&self, changes: &[(usize, &str)]) -> String {
        let mut arguments: Vec<&str> = self.arguments.iter().map(String::as_str).collect();
        for &(at, value) in changes {
            arguments[at] = value;
        }
        format!("{}({})", self.function.name, arguments.join(", "))
    }
}

/// Returns values as a list in C.
fn list(values: &str) -> String {
    values.split_whitespace().collect::<Vec<_>>().join(", ")
}

/// Returns numbers that no member of an enumeration has.
fn unknown(enumeration: &Enumeration) -> String {
    let last = enumeration.numbers.iter().max().copied().unwrap_or(0);
    let mut numbers: Vec<String> = (0..=last + 1)
        .chain([255])
        .filter(|number| !enumeration.numbers.contains(number))
        .map(|n| n.to_string())
        .collect();
    if enumeration.integer != "uint8_t" {
        numbers.extend(["256", "UINT32_MAX"].map(String::from));
    }
    numbers.join(" ")
}

/// Writes the parts of the program for `refused.c`.
pub fn write() {
    let program =
        program(&header(), &text("c_tests/refused.c")).unwrap_or_else(|problems| panic!("{problems}"));
    let folder = kit().folder("lists");
    for (name, text) in [("refused_structs.h", &program.structs), ("refused_calls.h", &program.calls)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    assert!(program.tried.len() > 3000, "{}", program.tried.len());
}

/// What the header may grow by: the test says what `refused.txt` and `refused.c` lack.
#[test]
fn new_functions_need_facts() {
    let added = "typedef struct leafless_news leafless_news;
        typedef struct leafless_novelty { double degree; } leafless_novelty;
        leafless_status leafless_news_new(const leafless_novelty *novelty, uint32_t editions,
            leafless_news **news);
        void leafless_news_free(leafless_news *news);
        bool leafless_news_is_good(const leafless_news *news);";
    let header = Header::read(&(text("include/leafless.h") + added));
    let Err(problems) = program(&header, &text("c_tests/refused.c")) else { panic!("nothing is missing") };
    for problem in [
        "refused.c: add HANDLE(news, ",
        "refused.c: add a valid `static leafless_novelty novelty`",
        "refused.txt, fields: add `novelty.degree: `",
        "refused.txt, valid: add `editions: ` or `news_new.editions: ` and a valid uint32_t",
        "refused.txt, numbers: add `editions: ` or `news_new.editions: `",
        "refused.rs: news_is_good returns no status",
    ] {
        assert!(problems.contains(problem), "{problem}\n{problems}");
    }
}
