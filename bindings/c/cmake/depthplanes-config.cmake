# find_package(depthplanes) gives two targets, for C and for C++17:
#   depthplanes::depthplanes  the shared library
#   depthplanes::static       the static library, with what it asks for of the system
# The folder may be moved as a whole.
include(CMakeFindDependencyMacro)
find_dependency(Threads)

if(NOT TARGET depthplanes::depthplanes)
    get_filename_component(_depthplanes_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
    add_library(depthplanes::depthplanes SHARED IMPORTED)
    set_target_properties(depthplanes::depthplanes PROPERTIES
        IMPORTED_LOCATION "${_depthplanes_prefix}/lib/libdepthplanes.so.@VERSION@"
        IMPORTED_SONAME "@SONAME@"
        INTERFACE_INCLUDE_DIRECTORIES "${_depthplanes_prefix}/include")
    add_library(depthplanes::static STATIC IMPORTED)
    set_target_properties(depthplanes::static PROPERTIES
        IMPORTED_LOCATION "${_depthplanes_prefix}/lib/libdepthplanes.a"
        INTERFACE_INCLUDE_DIRECTORIES "${_depthplanes_prefix}/include"
        INTERFACE_LINK_LIBRARIES "Threads::Threads;gcc_s;m;${CMAKE_DL_LIBS}")
    unset(_depthplanes_prefix)
endif()
