"""Where pictures come from: meshes, camera, light, clipping, quantisation."""
