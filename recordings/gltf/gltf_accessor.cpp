// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <tiny_gltf.h>

#include "recordings/gltf/gltf_model.h"

namespace marey::recordings {
namespace {

template <class T>
double value_of(const unsigned char* bytes, bool normalized) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  if constexpr (std::numeric_limits<T>::is_integer) {
    if (normalized) {
      return std::max(-1.0,
                      static_cast<double>(value) /
                          static_cast<double>(std::numeric_limits<T>::max()));
    }
  }
  return static_cast<double>(value);
}

using Decode = double (*)(const unsigned char*, bool);

Decode decoder(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return value_of<std::int8_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return value_of<std::uint8_t>;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return value_of<std::int16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return value_of<std::uint16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return value_of<std::uint32_t>;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return value_of<float>;
    default:
      return nullptr;
  }
}

template <class List>
bool holds(const List& list, int place) {
  return place >= 0 && static_cast<std::size_t>(place) < list.size();
}

}  // namespace

Error NamedModel::fail(std::string cause) const {
  return bad_input(
      file, std::move(cause), "export the file again, as binary glTF 2.0 (.glb)");
}

Result<std::vector<double>> accessor_values(const NamedModel& file,
                                            int accessor,
                                            std::size_t components) {
  const std::string name = "accessor " + std::to_string(accessor);
  const tinygltf::Model& model = file.model;
  if (!holds(model.accessors, accessor)) return file.fail(name + " does not exist");
  const tinygltf::Accessor& a = model.accessors[static_cast<std::size_t>(accessor)];
  if (a.sparse.isSparse) return file.fail(name + " is sparse, which marey cannot read");
  if (!holds(model.bufferViews, a.bufferView)) return file.fail(name + " has no data");
  const auto& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
  if (!holds(model.buffers, view.buffer)) return file.fail(name + " has no buffer");
  const auto& buffer = model.buffers[static_cast<std::size_t>(view.buffer)].data;

  const Decode decode = decoder(a.componentType);
  const int found = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type));
  if (decode == nullptr || found < 0 || static_cast<std::size_t>(found) != components) {
    return file.fail(name + " has the wrong type for its use");
  }
  const auto size = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType)));
  const std::size_t row = size * components;
  const std::size_t stride = view.byteStride > 0 ? view.byteStride : row;
  // Compared step by step, so that no sum of the file's numbers can overflow.
  const bool view_fits = view.byteOffset <= buffer.size() &&
                         view.byteLength <= buffer.size() - view.byteOffset;
  const bool rows_fit =
      a.count == 0 ||
      (a.byteOffset <= view.byteLength && row <= view.byteLength - a.byteOffset &&
       a.count - 1 <= (view.byteLength - a.byteOffset - row) / stride);
  if (!view_fits || !rows_fit || stride < row) {
    return file.fail(name + " reaches beyond the end of its buffer");
  }
  std::vector<double> values;
  values.reserve(a.count * components);
  for (std::size_t i = 0; i < a.count; ++i) {
    const unsigned char* bytes =
        buffer.data() + view.byteOffset + a.byteOffset + i * stride;
    for (std::size_t k = 0; k < components; ++k) {
      values.push_back(decode(bytes + k * size, a.normalized));
      if (!std::isfinite(values.back())) {
        return file.fail(name + " holds a number that is not finite");
      }
    }
  }
  return values;
}

}  // namespace marey::recordings
