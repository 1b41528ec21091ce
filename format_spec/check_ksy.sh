#!/usr/bin/env bash
# Compiles leafless.ksy and reads all test vectors with what comes out.
#
#   format_spec/check_ksy.sh [VECTORS]
#
# VECTORS is the folder with `valid` and `invalid`, by default the one beside this script. The compiler comes from npm
# and the runtime of the compiled code from PyPI, both in the versions named here and into a temporary folder that is
# removed at the end. Needs Node.js from version 18 on with npm, and Python from version 3.9 on with pip.
set -euo pipefail

compiler=kaitai-struct-compiler@0.11.0
yaml=js-yaml@4.1.0
runtime=kaitaistruct==0.11

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
vectors=${1:-$here/vectors}

fail() {
    echo "check_ksy.sh: $1" >&2
    exit 2
}
for program in node npm python3; do
    command -v "$program" >/dev/null || fail "$program is missing"
done
python3 -m pip --version >/dev/null 2>&1 || fail "pip is missing: python3 -m pip does not run"
[[ -d $vectors/valid && -d $vectors/invalid ]] || fail "no folders valid and invalid in $vectors"
vectors=$(cd -- "$vectors" && pwd)

work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

npm install --prefix "$work" --ignore-scripts --no-audit --no-fund --loglevel=error "$compiler" "$yaml" >/dev/null \
    || fail "npm could not install $compiler and $yaml"
PIP_ROOT_USER_ACTION=ignore python3 -m pip install --quiet --disable-pip-version-check --target "$work/python" \
    "$runtime" || fail "pip could not install $runtime"

# The npm package is a library without a command. Python is what is run below; the other languages have stricter types,
# and the compiler refuses for some of them what it lets pass for Python.
cat >"$work/compile.mjs" <<'END'
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import compiler from "kaitai-struct-compiler";
import yaml from "js-yaml";

const [, , description, folder] = process.argv;
const parsed = yaml.load(readFileSync(description, "utf8"));
for (const language of ["python", "cpp_stl", "java", "rust"]) {
    const files = await compiler.compile(language, parsed, null, false);
    mkdirSync(join(folder, language), { recursive: true });
    for (const [name, text] of Object.entries(files)) {
        writeFileSync(join(folder, language, name), text);
    }
    console.log(`compiled for ${language}`);
}
writeFileSync(join(folder, "python", "leafless.json"), JSON.stringify(parsed));
END
node "$work/compile.mjs" "$here/leafless.ksy" "$work" || fail "leafless.ksy does not compile"

PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$work/python python3 "$here/check_ksy.py" "$work/python/leafless.json" "$vectors"
