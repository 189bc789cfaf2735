// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/gltf/gltf_files.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include <tiny_gltf.h>

#include "recordings/base/atomic_file.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

bool is_ordinary(const std::string& path, void* /*files*/) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool read_whole(std::vector<unsigned char>* out,
                std::string* error,
                const std::string& path,
                void* user_data) {
  auto& files = *static_cast<ExternalFiles*>(user_data);
  std::error_code problem;
  const std::uint64_t size =
      is_ordinary(path, nullptr) ? fs::file_size(path, problem) : 0;
  if (problem || size > files.bytes_left) {
    *error += "the files that it names are larger than 1 GiB";
    return false;
  }
  const Result<std::string> bytes = read_file(path);
  if (!bytes) {
    *error += bytes.error().cause;
    return false;
  }
  files.bytes_left -= std::min<std::uint64_t>(files.bytes_left, bytes->size());
  out->assign(bytes->begin(), bytes->end());
  return true;
}

template <class T>
const T* entry(const std::vector<T>& list, int place) {
  if (place < 0 || static_cast<std::size_t>(place) >= list.size()) return nullptr;
  return &list[static_cast<std::size_t>(place)];
}

/// Counts numbers up to a limit.
class ReferredNumbers {
 public:
  explicit ReferredNumbers(const tinygltf::Model& model) : model_(model) {
    std::size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : model.buffers) bytes += buffer.data.size();
    constexpr std::size_t kAlwaysAllowed = 32'000'000;
    left_ = std::max(kAlwaysAllowed, 2 * bytes);
  }

  [[nodiscard]] bool fit() const { return !too_many_; }

  void add(std::size_t count, std::size_t components) {
    // Plus one for each: entries without numbers also take time.
    if (too_many_ || count >= left_ / components) {
      too_many_ = true;
    } else {
      left_ -= count * components + 1;
    }
  }
  void add_accessor(int accessor) {
    constexpr std::size_t kMaxComponents = 16;
    const tinygltf::Accessor* a = entry(model_.accessors, accessor);
    const int declared =
        a ? tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a->type)) : 1;
    add(a ? a->count : 0,
        std::clamp<std::size_t>(declared > 0 ? declared : 1, 1, kMaxComponents));
  }
  void add_mesh(const tinygltf::Node& node) {
    const tinygltf::Mesh* mesh = entry(model_.meshes, node.mesh);
    const tinygltf::Skin* skin = entry(model_.skins, node.skin);
    if (mesh == nullptr || skin == nullptr) return;
    add(skin->joints.size(), 16);
    for (const tinygltf::Primitive& primitive : mesh->primitives) {
      if (!fit()) return;
      add_accessor(primitive.indices);
      for (const auto& [name, accessor] : primitive.attributes) add_accessor(accessor);
    }
  }
  void add_animation(const tinygltf::Animation& animation) {
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      const auto* sampler = entry(animation.samplers, channel.sampler);
      if (sampler == nullptr) continue;
      add_accessor(sampler->input);
      add_accessor(sampler->output);
    }
  }

 private:
  const tinygltf::Model& model_;
  std::size_t left_ = 0;
  bool too_many_ = false;
};

}  // namespace

void read_external_files(tinygltf::TinyGLTF& loader, ExternalFiles& files) {
  loader.SetFsCallbacks({is_ordinary,
                         tinygltf::ExpandFilePath,
                         read_whole,
                         tinygltf::WriteWholeFile,
                         &files});
}

Status check_referred_numbers(const NamedModel& file) {
  ReferredNumbers numbers(file.model);
  for (const tinygltf::Node& node : file.model.nodes) {
    if (numbers.fit()) numbers.add_mesh(node);
  }
  if (!file.model.animations.empty()) {
    numbers.add_animation(file.model.animations.front());
  }
  if (numbers.fit()) return Done{};
  return file.fail(
      "its meshes and animation refer to the same few bytes so often that the result "
      "does not fit into memory");
}

Status select_animation(const std::string& file,
                        std::size_t animation,
                        tinygltf::Model& model) {
  if (animation == 0) return Done{};
  const NamedModel named{model, file};
  if (animation >= model.animations.size()) {
    return named.fail("it has no animation with the index " + std::to_string(animation));
  }
  std::swap(model.animations.front(), model.animations[animation]);
  return check_referred_numbers(named);
}

Status copy_buffered_images(const NamedModel& file, std::vector<std::string>& images) {
  const tinygltf::Model& model = file.model;
  images.resize(model.images.size());
  std::size_t left = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) left += 4 * buffer.data.size();
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (model.images[i].bufferView < 0) continue;
    const auto* view = entry(model.bufferViews, model.images[i].bufferView);
    const auto* buffer = view ? entry(model.buffers, view->buffer) : nullptr;
    const bool fits = buffer && view->byteOffset <= buffer->data.size() &&
                      view->byteLength <= buffer->data.size() - view->byteOffset;
    if (!fits) {
      return file.fail("image " + std::to_string(i) +
                       " reaches beyond the end of its buffer");
    }
    if (view->byteLength > left) {
      return file.fail(
          "its images refer to the same bytes so often that they do not fit "
          "into memory");
    }
    left -= view->byteLength;
    const auto from =
        buffer->data.begin() + static_cast<std::ptrdiff_t>(view->byteOffset);
    images[i].assign(from, from + static_cast<std::ptrdiff_t>(view->byteLength));
  }
  return Done{};
}

}  // namespace marey::recordings
