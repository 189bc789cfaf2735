// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/gltf/gltf_builder.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

namespace marey::recordings {
namespace {

constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;

// GLB is little-endian, as are all supported machines.
template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

void pad(std::string& bytes, char with) {
  while (bytes.size() % 4 != 0) bytes += with;
}

int add_to(Json& document, const char* list, Json item) {
  Json& items = document[list];
  items.push_back(std::move(item));
  return static_cast<int>(items.size()) - 1;
}

Json bounds_of(std::span<const float> values, std::size_t components, bool largest) {
  Json bounds = Json::array();
  for (std::size_t k = 0; k < components; ++k) {
    float bound = values[k];
    for (std::size_t i = k; i < values.size(); i += components) {
      bound = largest ? std::max(bound, values[i]) : std::min(bound, values[i]);
    }
    bounds.push_back(bound);
  }
  return bounds;
}

}  // namespace

int GltfBuilder::add_view(std::string_view bytes, int target) {
  pad(buffer_, '\0');
  Json view{{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  buffer_ += bytes;
  return add_to(document_, "bufferViews", std::move(view));
}

int GltfBuilder::add_accessor(Json accessor) {
  return add_to(document_, "accessors", std::move(accessor));
}

int GltfBuilder::add_floats(std::span<const float> values,
                            std::size_t components,
                            const char* type,
                            bool bounds,
                            int target) {
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()),
                               values.size_bytes());
  Json accessor{{"bufferView", add_view(bytes, target)},
                {"componentType", kFloat},
                {"count", values.size() / components},
                {"type", type}};
  if (bounds) {
    accessor["min"] = bounds_of(values, components, false);
    accessor["max"] = bounds_of(values, components, true);
  }
  return add_accessor(std::move(accessor));
}

int GltfBuilder::add_integers(std::span<const std::uint32_t> values,
                              std::size_t components,
                              const char* type,
                              std::uint32_t largest,
                              int target) {
  // Indices must be less than the type's largest value.
  const int component_type = largest < UINT8_MAX && components == 4 ? kUnsignedByte
                             : largest < UINT16_MAX                 ? kUnsignedShort
                                                                    : kUnsignedInt;
  std::string bytes;
  for (const std::uint32_t value : values) {
    if (component_type == kUnsignedByte) {
      append(bytes, static_cast<std::uint8_t>(value));
    } else if (component_type == kUnsignedShort) {
      append(bytes, static_cast<std::uint16_t>(value));
    } else {
      append(bytes, value);
    }
  }
  return add_accessor({{"bufferView", add_view(bytes, target)},
                       {"componentType", component_type},
                       {"count", values.size() / components},
                       {"type", type}});
}

std::string GltfBuilder::glb() const {
  std::string buffer = buffer_;
  pad(buffer, '\0');
  document_["buffers"] = Json::array({Json{{"byteLength", buffer.size()}}});
  std::string json = document_.dump();
  pad(json, ' ');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

Json make_animation(GltfBuilder& builder,
                    std::span<const NodeTrack> tracks,
                    std::size_t frames,
                    FrameRate rate,
                    std::string_view name) {
  std::vector<float> times_s;
  for (std::size_t i = 0; i < frames; ++i) {
    times_s.push_back(static_cast<float>(static_cast<double>(i) / rate.hz));
  }
  const int input = builder.add_floats(times_s, 1, "SCALAR", true);
  Json channels = Json::array();
  Json samplers = Json::array();
  const auto add = [&](int node, const char* path, int output) {
    channels.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers.push_back(
        {{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
  };
  std::vector<float> values;
  const auto push = [&](double value) { values.push_back(static_cast<float>(value)); };
  for (const NodeTrack& track : tracks) {
    if (!track.translations.empty()) {
      values.clear();
      for (const glm::dvec3& t : track.translations) push(t.x), push(t.y), push(t.z);
      add(track.node, "translation", builder.add_floats(values, 3, "VEC3", false));
    }
    if (!track.rotations.empty()) {
      values.clear();
      glm::dquat last = track.rotations.front();
      for (glm::dquat q : track.rotations) {
        if (glm::dot(q, last) < 0.0) q = -q;
        q = last = glm::normalize(q);
        push(q.x), push(q.y), push(q.z), push(q.w);
      }
      add(track.node, "rotation", builder.add_floats(values, 4, "VEC4", false));
    }
  }
  return {{"name", name},
          {"channels", std::move(channels)},
          {"samplers", std::move(samplers)}};
}

}  // namespace marey::recordings
