"""Leafless as a package for Conan 2, built from the clone that this file lies in. It needs cargo."""

import os
import re

from conan import ConanFile
from conan.tools.env import Environment
from conan.tools.files import copy, load

ROOT = os.path.join("..", "..")


class Leafless(ConanFile):
    name = "leafless"
    description = "A solid-modelling kernel on octrees without leaves, with interfaces for C and C++"
    license = "MIT OR Apache-2.0"
    topics = ("cad", "csg", "octree", "solid", "voxel")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    no_copy_source = True

    def set_version(self):
        manifest = load(self, os.path.join(self.recipe_folder, ROOT, "capi", "Cargo.toml"))
        self.version = re.search(r'^version = "(.*)"', manifest, re.MULTILINE).group(1)

    def export_sources(self):
        root = os.path.join(self.recipe_folder, ROOT)
        excludes = ["target/*", "*/target/*", ".git/*", "docs/*", "fuzz/*", "packaging/conan/test_package/build/*"]
        copy(self, "*", root, self.export_sources_folder, excludes=excludes)

    def package_id(self):
        # What rustc makes depends on neither.
        del self.info.settings.compiler
        del self.info.settings.build_type

    def _cargo(self, command):
        environment = Environment()
        environment.define("CARGO_TARGET_DIR", os.path.join(self.build_folder, "target"))
        with environment.vars(self).apply():
            self.run(f"cargo {command}", cwd=self.source_folder)

    def build(self):
        self._cargo("build --profile shipped --package leafless-capi")

    def package(self):
        only = "shared" if self.options.shared else "static"
        self._cargo(f'run --profile shipped --package leafless-capi -- --prefix "{self.package_folder}" --only {only}')

    def package_info(self):
        self.cpp_info.libs = ["leafless"]
        # CMake takes the package's own files, other tools what pkg-config would tell.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "leafless")]
        if not self.options.shared:
            libraries = load(self, os.path.join(self.package_folder, "lib", "pkgconfig", "leafless.pc"))
            private = re.search(r"^Libs.private: (.*)", libraries, re.MULTILINE).group(1)
            self.cpp_info.system_libs = [word.removeprefix("-l") for word in private.split()]
