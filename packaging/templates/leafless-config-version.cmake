# Below 1.0 a version fits programs for the same minor version, and from 1.0 on for the same major version.

set(PACKAGE_VERSION "@VERSION@")

string(REGEX MATCH "^([0-9]+)\\.([0-9]+)" _leafless_series "${PACKAGE_VERSION}")
set(_leafless_wanted "${PACKAGE_FIND_VERSION_MAJOR}.${PACKAGE_FIND_VERSION_MINOR}")
if(CMAKE_MATCH_1 GREATER 0)
  set(_leafless_series "${CMAKE_MATCH_1}")
  set(_leafless_wanted "${PACKAGE_FIND_VERSION_MAJOR}")
endif()

if(PACKAGE_FIND_VERSION_COUNT EQUAL 0)
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
elseif(_leafless_wanted VERSION_EQUAL _leafless_series AND NOT PACKAGE_VERSION VERSION_LESS PACKAGE_FIND_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  if(PACKAGE_VERSION VERSION_EQUAL PACKAGE_FIND_VERSION)
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
endif()

# A project without languages does not know the size of a pointer, and links nothing.
if(CMAKE_SIZEOF_VOID_P AND NOT CMAKE_SIZEOF_VOID_P EQUAL @POINTER@)
  set(PACKAGE_VERSION_UNSUITABLE TRUE)
endif()

unset(_leafless_series)
unset(_leafless_wanted)
