# The GPU's kernels that take samples: a file for each kind of lens, kind of scene and set of effects, so that they
# compile side by side. Together they take minutes, so those with effects are compiled for fewer kinds: the rest is
# served by a kernel for any lens and any scene (kernel_for in cpp/cuda/render_kernel.cu).
function(realcam_add_render_kernels target)
  set(kinds "0 plain plain" "0 plain opaque" "0 plain any" "0 any plain" "0 any opaque" "0 any any")
  foreach(effects IN ITEMS 1 2 3 4 5) # their numbers in kCompiledEffects
    list(APPEND kinds "${effects} plain plain" "${effects} any plain" "${effects} any any")
  endforeach()
  foreach(kind IN LISTS kinds)
    separate_arguments(kind)
    list(GET kind 0 effects)
    list(GET kind 1 lens)
    list(GET kind 2 scene)
    set(file ${PROJECT_BINARY_DIR}/cuda/render_kernel_effects${effects}_${lens}_lens_${scene}_scene.cu)
    configure_file(${PROJECT_SOURCE_DIR}/cpp/cuda/render_kernel_instance.cu.in ${file} @ONLY)
    target_sources(${target} PRIVATE ${file})
  endforeach()
endfunction()
