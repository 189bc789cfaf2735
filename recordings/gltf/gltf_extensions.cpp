// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/gltf/gltf_extensions.h"

#include <string>

#include <tiny_gltf.h>

namespace marey::recordings {

Status check_extensions(const NamedModel& file) {
  for (const std::string& extension : file.model.extensionsRequired) {
    if (extension == "KHR_draco_mesh_compression") {
      return bad_input(
          file.file,
          "the meshes are compressed with KHR_draco_mesh_compression (Draco), "
          "which marey does not read",
          "export it without compression (in Blender: glTF export, Data, "
          "Compression off), or run: npx @gltf-transform/cli copy IN.glb "
          "OUT.glb");
    }
    if (extension == "EXT_meshopt_compression" ||
        extension == "KHR_meshopt_compression") {
      return bad_input(
          file.file,
          "the data are compressed with " + extension +
              " (meshoptimizer), which marey does not read",
          "export it without compression (gltfpack: leave out -c and -cc), or "
          "run: npx @gltf-transform/cli copy IN.glb OUT.glb");
    }
    const bool is_look =
        extension.starts_with("KHR_materials_") ||
        extension.starts_with("KHR_texture_") || extension.starts_with("EXT_texture_") ||
        extension.starts_with("MSFT_texture_") || extension.starts_with("KHR_lights_") ||
        extension == "VRM" || extension.starts_with("VRMC_") ||
        extension == "KHR_mesh_quantization";
    if (is_look) continue;
    return bad_input(file.file,
                     "the file requires the extension " + extension.substr(0, 80) +
                         ", which marey does not read",
                     "export it without this extension");
  }
  return Done{};
}

}  // namespace marey::recordings
