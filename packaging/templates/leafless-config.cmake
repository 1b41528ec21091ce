# find_package(leafless) makes these targets:
#
#   leafless::static     the static library, with the system's libraries that it needs
#   leafless::shared     the shared library
#   leafless::leafless   the shared library if it is installed, else the static one
#
# The prefix is found from the place of this file.

get_filename_component(_leafless_prefix "${CMAKE_CURRENT_LIST_DIR}/@UP@" ABSOLUTE)

if(NOT TARGET leafless::static AND EXISTS "${_leafless_prefix}/@LIBDIR@/@ARCHIVE@")
  add_library(leafless::static STATIC IMPORTED)
  set_target_properties(leafless::static PROPERTIES
    IMPORTED_LOCATION "${_leafless_prefix}/@LIBDIR@/@ARCHIVE@"
    INTERFACE_INCLUDE_DIRECTORIES "${_leafless_prefix}/include"
    INTERFACE_LINK_LIBRARIES "@NATIVE_LIST@")
endif()

if(NOT TARGET leafless::shared AND EXISTS "${_leafless_prefix}/@SHARED@")
  add_library(leafless::shared SHARED IMPORTED)
  set_target_properties(leafless::shared PROPERTIES
    IMPORTED_LOCATION "${_leafless_prefix}/@SHARED@"
    INTERFACE_INCLUDE_DIRECTORIES "${_leafless_prefix}/include")
  if(WIN32)
    set_target_properties(leafless::shared PROPERTIES IMPORTED_IMPLIB "${_leafless_prefix}/@IMPORT@")
  endif()
endif()

if(NOT TARGET leafless::leafless)
  add_library(leafless::leafless INTERFACE IMPORTED)
  if(TARGET leafless::shared)
    set_target_properties(leafless::leafless PROPERTIES INTERFACE_LINK_LIBRARIES leafless::shared)
  else()
    set_target_properties(leafless::leafless PROPERTIES INTERFACE_LINK_LIBRARIES leafless::static)
  endif()
endif()

# COMPONENTS static or shared asks for one of the libraries.
foreach(_leafless_part IN LISTS leafless_FIND_COMPONENTS)
  if(TARGET leafless::${_leafless_part})
    set(leafless_${_leafless_part}_FOUND TRUE)
  elseif(leafless_FIND_REQUIRED_${_leafless_part})
    set(leafless_FOUND FALSE)
    set(leafless_NOT_FOUND_MESSAGE "leafless::${_leafless_part} is not installed in ${_leafless_prefix}")
  endif()
endforeach()

unset(_leafless_prefix)
unset(_leafless_part)
