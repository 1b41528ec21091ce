//! The contents of the header, read as text.

/// A parameter of a function, or a field of a struct.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// The type without `const` and `*`.
    pub base: String,
    pub is_const: bool,
    pub pointers: usize,
    pub name: String,
    pub array: Option<usize>,
    /// For an array of any length, how many numbers each element has.
    pub dimension: usize,
}

impl Parameter {
    fn parse(text: &str) -> Parameter {
        let (text, array) = match text.split_once('[') {
            Some((text, size)) => (text, Some(size.trim_end_matches(']').parse().expect("a size"))),
            None => (text, None),
        };
        let is_const = text.starts_with("const ");
        let (kind, name) = text.split_at(text.rfind([' ', '*']).expect("a type and a name") + 1);
        let base = kind.trim_start_matches("const ").split([' ', '*']).next().expect("a type");
        let pointers = kind.matches('*').count();
        Parameter { base: base.to_string(), is_const, pointers, name: name.to_string(), array, dimension: 1 }
    }
}

pub struct Function {
    pub name: String,
    pub result: String,
    pub parameters: Vec<Parameter>,
}

/// An enumeration of a fixed size.
pub struct Enumeration {
    pub name: String,
    pub integer: String,
    pub numbers: Vec<u32>,
}

#[derive(Default)]
pub struct Header {
    pub functions: Vec<Function>,
    /// Structs with public fields.
    pub structs: Vec<(String, Vec<Parameter>)>,
    pub enumerations: Vec<Enumeration>,
    /// Enumerators, and macros that are numbers.
    pub values: Vec<String>,
    /// All other names: opaque structs, enumerations, function types, other macros, and functions defined in
    /// the header, which no library exports.
    others: Vec<String>,
}

/// The text without comments.
fn code(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some((before, comment)) = rest.split_once("/*") {
        code.push_str(before);
        rest = comment.split_once("*/").expect("a closed comment").1;
    }
    code.push_str(rest);
    code.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Returns the last name in a declarator, without the brackets behind it.
fn declared(declarator: &str) -> &str {
    let name = declarator.split('[').next().unwrap_or_default().trim();
    name.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default()
}

/// Returns the text after the body that `text` begins with.
fn after_body(text: &str) -> &str {
    let mut depth = 0;
    for (at, brace) in text.match_indices(['{', '}']) {
        depth = if brace == "{" { depth + 1 } else { depth - 1 };
        if depth == 0 {
            return &text[at + 1..];
        }
    }
    panic!("a closed body: {text}")
}

impl Header {
    pub fn read(text: &str) -> Header {
        let code = code(text);
        let mut header = Header::default();
        for line in code.lines() {
            if let Some(rest) = line.strip_prefix("#define ") {
                let (name, value) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
                let name = name.split('(').next().unwrap();
                if value.trim().parse::<i64>().is_ok() {
                    header.values.push(name.to_string());
                } else {
                    header.others.push(name.to_string());
                }
            }
        }
        // A backslash continues a macro on the next line.
        let mut plain = String::new();
        let mut is_macro = false;
        for line in code.lines() {
            is_macro |= line.trim_start().starts_with('#');
            if !is_macro {
                plain.push_str(line);
                plain.push('\n');
            }
            is_macro &= line.ends_with('\\');
        }
        let mut rest = plain.as_str();
        while let Some(end) = rest.find([';', '{']) {
            let declaration = rest[..end].trim();
            if let Some(inline) = declaration.strip_prefix("static inline ") {
                header.others.push(declared(inline.split('(').next().unwrap_or_default()).to_string());
                rest = after_body(&rest[end..]);
                continue;
            }
            if rest[end..].starts_with('{') && !declaration.ends_with("\"C\"") {
                let (body, after) = rest[end + 1..].split_once('}').expect("a closed body");
                if let Some((_, enumeration)) = declaration.rsplit_once("LEAFLESS_ENUM(") {
                    let (name, integer) = enumeration.split_once(", ").expect("a name and an integer");
                    header.others.push(name.to_string());
                    let numbers = body.split(',').filter_map(|value| value.split_once('='));
                    header.enumerations.push(Enumeration {
                        name: name.to_string(),
                        integer: integer.trim_end_matches(')').to_string(),
                        numbers: numbers.filter_map(|(_, number)| number.trim().parse().ok()).collect(),
                    });
                    let names = body.split(',').filter_map(|value| value.split('=').next());
                    header
                        .values
                        .extend(names.map(|name| name.trim().to_string()).filter(|name| !name.is_empty()));
                } else {
                    let fields = body.split(';').map(str::trim).filter(|field| !field.is_empty());
                    let name = declared(after.split(';').next().unwrap_or_default());
                    header.structs.push((name.to_string(), fields.map(Parameter::parse).collect()));
                }
                rest = after.split_once(';').expect("a semicolon after a body").1;
                continue;
            }
            rest = &rest[end + 1..];
            if declaration.starts_with("typedef ") {
                let name = match declaration.split_once("(*") {
                    Some((_, function)) => function.split_once(')').unwrap().0,
                    None => declared(declaration),
                };
                header.others.push(name.to_string());
            } else if let Some((before, parameters)) = declaration.split_once('(') {
                let (result, name) = before.split_at(before.rfind([' ', '*']).expect("a result") + 1);
                let list = parameters.trim_end_matches(')').split(',');
                let list = list.map(|text| text.split_whitespace().collect::<Vec<_>>().join(" "));
                header.functions.push(Function {
                    name: name.to_string(),
                    result: result.trim().to_string(),
                    parameters: list
                        .filter(|text| text != "void")
                        .map(|text| Parameter::parse(&text))
                        .collect(),
                });
            }
        }
        header
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        let functions = self.functions.iter().map(|function| function.name.as_str());
        let structs = self.structs.iter().map(|(name, _)| name.as_str());
        functions.chain(structs).chain(self.values.iter().chain(&self.others).map(String::as_str))
    }
}

/// Returns all words that begin with the prefix.
pub fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = text
        .split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with("leafless_") || word.starts_with("LEAFLESS_"))
        .map(str::to_string)
        .collect();
    words.sort();
    words.dedup();
    words
}
