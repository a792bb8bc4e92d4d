# The targets fingertip::static, fingertip::shared and fingertip::fingertip, of a build and of an installation alike.

# As FT_ABI_VERSION of fingertip.h.
set(FINGERTIP_ABI_VERSION 1)

function(fingertip_targets include lib)
    # What the standard library of Rust asks of the system: `rustc --print native-static-libs`.
    set(system gcc_s util rt pthread m dl c)
    add_library(fingertip::static STATIC IMPORTED GLOBAL)
    set_target_properties(fingertip::static PROPERTIES
        IMPORTED_LOCATION "${lib}/libfingertip.a"
        INTERFACE_INCLUDE_DIRECTORIES "${include}"
        INTERFACE_LINK_LIBRARIES "${system}")
    add_library(fingertip::shared SHARED IMPORTED GLOBAL)
    set_target_properties(fingertip::shared PROPERTIES
        IMPORTED_LOCATION "${lib}/libfingertip.so.${FINGERTIP_ABI_VERSION}"
        IMPORTED_SONAME "libfingertip.so.${FINGERTIP_ABI_VERSION}"
        INTERFACE_INCLUDE_DIRECTORIES "${include}")
    if(BUILD_SHARED_LIBS)
        set(usual fingertip::shared)
    else()
        set(usual fingertip::static)
    endif()
    add_library(fingertip::fingertip INTERFACE IMPORTED GLOBAL)
    set_target_properties(fingertip::fingertip PROPERTIES INTERFACE_LINK_LIBRARIES "${usual}")
endfunction()
