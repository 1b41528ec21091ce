# An overlay port, which builds the clone that it lies in. vcpkg has no means to install Rust: cargo must be there.
find_program(CARGO cargo REQUIRED)

# Rust's libraries have no variant for debugging programs in C or C++.
set(VCPKG_BUILD_TYPE release)

set(only static)
if(VCPKG_LIBRARY_LINKAGE STREQUAL "dynamic")
  set(only shared)
endif()

vcpkg_execute_required_process(
  COMMAND ${CMAKE_COMMAND} -E env "CARGO_TARGET_DIR=${CURRENT_BUILDTREES_DIR}/cargo"
    "${CARGO}" run --profile shipped --package leafless-capi --
    --prefix "${CURRENT_PACKAGES_DIR}" --cmakedir "share/${PORT}" --only "${only}"
  WORKING_DIRECTORY "${CMAKE_CURRENT_LIST_DIR}/../.."
  LOGNAME "install-${TARGET_TRIPLET}")

vcpkg_fixup_pkgconfig()

# vcpkg wants one file of all licences.
vcpkg_install_copyright(FILE_LIST
  "${CURRENT_PACKAGES_DIR}/share/licenses/leafless/LICENSE-MIT"
  "${CURRENT_PACKAGES_DIR}/share/licenses/leafless/LICENSE-APACHE"
  "${CURRENT_PACKAGES_DIR}/share/licenses/leafless/THIRD-PARTY.txt")
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/share/licenses")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
