// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "recordings/gltf/gltf_model.h"

namespace tinygltf {
class Model;
class TinyGLTF;
}  // namespace tinygltf

// Private to recordings/: limits of the data that a small glTF file can load.
namespace marey::recordings {

/// Budget of the files that a glTF references: regular files only, of a limited total
/// size.
struct ExternalFiles {
  std::uint64_t bytes_left = std::uint64_t{1} << 30;
};

/// Makes `loader` read external files through `files`, which must outlive its loading.
void read_external_files(tinygltf::TinyGLTF& loader, ExternalFiles& files);

/// Checks, before any accessor is read, how many numbers the skinned meshes and the first
/// animation reference. A file may reference one accessor any number of times. Errors:
/// more than 32 million and more than two for each byte of its buffers.
[[nodiscard]] Status check_referred_numbers(const NamedModel& file);

/// Makes the animation with this index the first one of the model. Errors: it does not
/// exist, unless the index is 0; check_referred_numbers()'s.
[[nodiscard]] Status select_animation(const std::string& file,
                                      std::size_t animation,
                                      tinygltf::Model& model);

/// Copies the bytes of the images in buffers into `images`, one entry for each image.
/// Errors: an image extends beyond its buffer; their total is more than four times the
/// buffers' size.
[[nodiscard]] Status copy_buffered_images(const NamedModel& file,
                                          std::vector<std::string>& images);

}  // namespace marey::recordings
