# What voxref builds on and what a program that uses its installed libraries must find again.
include(CMakeFindDependencyMacro)

# Embree 4 where it is installed, else Embree 3 (Debian 12).
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_dependency(embree 3 CONFIG)
endif()
find_dependency(glm CONFIG)
find_dependency(TinyGLTF CONFIG)
find_dependency(OpenImageIO CONFIG)
find_dependency(TBB CONFIG)
find_dependency(OpenSSL COMPONENTS Crypto)
find_dependency(nlohmann_json CONFIG)
find_dependency(fmt CONFIG)

# Debian's OpenImageIO 2.4 names the include folder of OpenCV, which its package does not bring and its headers do not
# need; CMake refuses folders that are not there.
get_target_property(_voxref_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(_voxref_oiio_present "")
foreach(_voxref_folder IN LISTS _voxref_oiio_includes)
  if(IS_DIRECTORY "${_voxref_folder}")
    list(APPEND _voxref_oiio_present "${_voxref_folder}")
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_voxref_oiio_present}")
