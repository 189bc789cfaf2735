// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/posed_glb.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace marey::testing {

struct GlbFile {
  nlohmann::json json;
  std::string bin;
};

namespace {

using Json = nlohmann::json;

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t out = 0;
  std::memcpy(&out, bytes.data() + at, 4);
  return out;
}

GlbFile read_glb(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (bytes.size() < 20 || bytes.compare(0, 4, "glTF") != 0) {
    throw std::runtime_error(path.string() + ": no GLB");
  }
  GlbFile file;
  std::size_t at = 12;
  while (at + 8 <= bytes.size()) {
    const std::size_t size = word(bytes, at);
    const std::string chunk = bytes.substr(at + 8, size);
    if (bytes.compare(at + 4, 4, "JSON") == 0) file.json = Json::parse(chunk);
    if (bytes.compare(at + 4, 3, "BIN") == 0) file.bin = chunk;
    at += 8 + size;
  }
  return file;
}

std::size_t width(int type) {
  return type == 5126 || type == 5125 ? 4 : type == 5122 || type == 5123 ? 2 : 1;
}

double number_at(const std::string& bin, std::size_t at, int type, bool normalized) {
  const auto get = [&](auto value) {
    std::memcpy(&value, bin.data() + at, sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case 5126:
      return get(float{});
    case 5125:
      return get(std::uint32_t{});
    case 5123:
      return get(std::uint16_t{}) / (normalized ? 65535.0 : 1.0);
    case 5122:
      return std::max(get(std::int16_t{}) / (normalized ? 32767.0 : 1.0),
                      normalized ? -1.0 : -1e9);
    case 5121:
      return get(std::uint8_t{}) / (normalized ? 255.0 : 1.0);
    default:
      return std::max(get(std::int8_t{}) / (normalized ? 127.0 : 1.0),
                      normalized ? -1.0 : -1e9);
  }
}

std::vector<double> numbers(const GlbFile& file, const Json& accessor_index) {
  const Json& accessor = file.json.at("accessors").at(accessor_index.get<std::size_t>());
  if (accessor.contains("sparse")) throw std::runtime_error("sparse accessor");
  const std::string type = accessor.at("type");
  const std::size_t components = type == "SCALAR" ? 1
                                 : type == "VEC2" ? 2
                                 : type == "VEC3" ? 3
                                 : type == "VEC4" ? 4
                                                  : 16;
  const Json& view =
      file.json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
  if (view.value("buffer", 0) != 0) throw std::runtime_error("more than one buffer");
  const int kind = accessor.at("componentType");
  const std::size_t stride = view.value("byteStride", components * width(kind));
  const std::size_t start = view.value("byteOffset", std::size_t{0}) +
                            accessor.value("byteOffset", std::size_t{0});
  const std::size_t count = accessor.at("count");
  std::vector<double> out;
  out.reserve(count * components);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < components; ++c) {
      const std::size_t at = start + i * stride + c * width(kind);
      if (at + width(kind) > file.bin.size()) throw std::runtime_error("short buffer");
      out.push_back(number_at(file.bin, at, kind, accessor.value("normalized", false)));
    }
  }
  return out;
}

glm::dmat4 matrix_of(const double* m) {
  glm::dmat4 out(1.0);
  for (int k = 0; k < 16; ++k) out[k / 4][k % 4] = m[k];
  return out;
}

}  // namespace

PosedGlb::PosedGlb(const std::filesystem::path& path) {
  const GlbFile file = read_glb(path);
  read_nodes(file);
  for (const Json& node : file.json["nodes"]) {
    if (node.contains("mesh") && node.contains("skin")) read_skin(file, node);
  }
  if (parts_.empty()) throw std::runtime_error(path.string() + ": no skin");
  if (file.json.contains("animations") && !file.json["animations"].empty()) {
    read_animation(file, file.json["animations"][0]);
  }
  pose(0.0);
}

void PosedGlb::read_nodes(const GlbFile& file) {
  for (const Json& node : file.json.at("nodes")) {
    Node out;
    if (const auto v = node.value("translation", std::vector<double>{}); v.size() == 3) {
      out.translation = {v[0], v[1], v[2]};
    }
    if (const auto v = node.value("rotation", std::vector<double>{}); v.size() == 4) {
      out.rotation = glm::dquat(v[3], v[0], v[1], v[2]);
    }
    if (const auto v = node.value("scale", std::vector<double>{}); v.size() == 3) {
      out.scale = {v[0], v[1], v[2]};
    }
    if (const auto v = node.value("matrix", std::vector<double>{}); v.size() == 16) {
      out.matrix = matrix_of(v.data());
    }
    names_.push_back(node.value("name", ""));
    nodes_.push_back(out);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Json& node = file.json["nodes"][i];
    if (!node.contains("children")) continue;
    for (const Json& child : node["children"]) {
      nodes_.at(child.get<std::size_t>()).parent = static_cast<int>(i);
    }
  }
  std::vector<char> placed(nodes_.size(), 0);
  while (order_.size() < nodes_.size()) {
    const std::size_t before = order_.size();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int parent = nodes_[i].parent;
      if (placed[i] != 0) continue;
      if (parent >= 0 && placed[static_cast<std::size_t>(parent)] == 0) continue;
      placed[i] = 1;
      order_.push_back(i);
    }
    if (order_.size() == before) throw std::runtime_error("the nodes are not a tree");
  }
}

void PosedGlb::read_skin(const GlbFile& file, const Json& node) {
  const Json& skin = file.json.at("skins").at(node["skin"].get<std::size_t>());
  const Json& mesh = file.json.at("meshes").at(node["mesh"].get<std::size_t>());
  std::vector<double> binds;
  if (skin.contains("inverseBindMatrices")) {
    binds = numbers(file, skin["inverseBindMatrices"]);
  }
  for (const Json& primitive : mesh.at("primitives")) {
    SkinnedPart part;
    for (const Json& joint : skin.at("joints")) {
      part.inverse_bind.push_back(
          binds.empty() ? glm::dmat4(1.0)
                        : matrix_of(binds.data() + 16 * part.joints.size()));
      part.joints.push_back(joint);
    }
    const Json& attributes = primitive.at("attributes");
    const auto positions = numbers(file, attributes.at("POSITION"));
    part.influences.resize(positions.size() / 3);
    for (std::size_t v = 0; v < positions.size(); v += 3) {
      part.places.emplace_back(positions[v], positions[v + 1], positions[v + 2]);
    }
    for (int set = 0;; ++set) {
      const std::string number = std::to_string(set);
      if (!attributes.contains("JOINTS_" + number)) break;
      const auto joints = numbers(file, attributes["JOINTS_" + number]);
      const auto weights = numbers(file, attributes.at("WEIGHTS_" + number));
      for (std::size_t k = 0; k < weights.size(); ++k) {
        if (weights[k] <= 0.0) continue;
        part.influences.at(k / 4).push_back(
            {static_cast<std::size_t>(joints[k]), weights[k]});
      }
    }
    for (auto& influences : part.influences) {
      double sum = 0.0;
      for (const Influence& one : influences) sum += one.weight;
      for (Influence& one : influences) one.weight /= sum;
    }
    parts_.push_back(std::move(part));
  }
}

void PosedGlb::read_animation(const GlbFile& file, const Json& animation) {
  for (const Json& channel : animation.at("channels")) {
    if (!channel.at("target").contains("node")) continue;
    const std::string path_name = channel["target"].at("path");
    if (path_name == "weights") continue;
    const Json& sampler =
        animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
    const std::string way = sampler.value("interpolation", "LINEAR");
    if (way == "CUBICSPLINE") throw std::runtime_error("cubic spline");
    Channel out;
    out.node = channel["target"]["node"];
    out.path = path_name[0];
    out.steps = way == "STEP";
    out.times = numbers(file, sampler.at("input"));
    out.values = numbers(file, sampler.at("output"));
    if (out.times.size() > times_.size()) times_ = out.times;
    channels_.push_back(std::move(out));
  }
}

std::optional<std::size_t> PosedGlb::node(const std::string& name) const {
  const auto found = std::ranges::find(names_, name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

void PosedGlb::pose(double time_s) {
  std::vector<Node> posed = nodes_;
  for (const Channel& channel : channels_) {
    const auto& times = channel.times;
    const std::size_t n = channel.path == 'r' ? 4 : 3;
    const auto after = std::ranges::upper_bound(times, time_s);
    const auto high =
        std::min(static_cast<std::size_t>(after - times.begin()), times.size() - 1);
    const std::size_t low =
        after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
    double share = 0.0;
    if (high > low && !channel.steps) {
      share = (time_s - times[low]) / (times[high] - times[low]);
    }
    const double* a = channel.values.data() + n * low;
    const double* b = channel.values.data() + n * high;
    Node& node = posed[channel.node];
    node.matrix.reset();
    if (channel.path == 'r') {
      node.rotation = glm::slerp(
          glm::dquat(a[3], a[0], a[1], a[2]), glm::dquat(b[3], b[0], b[1], b[2]), share);
    } else {
      const glm::dvec3 value =
          glm::mix(glm::dvec3(a[0], a[1], a[2]), glm::dvec3(b[0], b[1], b[2]), share);
      (channel.path == 't' ? node.translation : node.scale) = value;
    }
  }
  world_.assign(nodes_.size(), glm::dmat4(1.0));
  for (const std::size_t i : order_) {
    const Node& node = posed[i];
    glm::dmat4 local(1.0);
    if (node.matrix) {
      local = *node.matrix;
    } else {
      local = glm::mat4_cast(glm::normalize(node.rotation));
      for (int c = 0; c < 3; ++c) local[c] *= node.scale[c];
      local[3] = glm::dvec4(node.translation, 1.0);
    }
    world_[i] =
        node.parent < 0 ? local : world_[static_cast<std::size_t>(node.parent)] * local;
  }
}

glm::dvec3 PosedGlb::place(std::size_t node) const {
  return glm::dvec3(world_.at(node)[3]);
}

PosedGlb::Lowest PosedGlb::lowest() const {
  Lowest out;
  for (const SkinnedPart& part : parts_) {
    std::vector<glm::dvec4> rows;
    for (std::size_t j = 0; j < part.joints.size(); ++j) {
      const glm::dmat4 m = world_[part.joints[j]] * part.inverse_bind[j];
      rows.emplace_back(m[0][1], m[1][1], m[2][1], m[3][1]);
    }
    for (std::size_t v = 0; v < part.places.size(); ++v) {
      const glm::dvec3& p = part.places[v];
      double y_m = 0.0;
      for (const Influence& one : part.influences[v]) {
        const glm::dvec4& row = rows[one.joint];
        y_m += one.weight * (row.x * p.x + row.y * p.y + row.z * p.z + row.w);
      }
      if (part.influences[v].empty() || y_m >= out.y_m) continue;
      out.y_m = y_m;
      const auto maximum =
          std::ranges::max_element(part.influences[v], {}, &Influence::weight);
      out.node = names_[part.joints[maximum->joint]];
    }
  }
  return out;
}

std::size_t PosedGlb::vertex_count() const {
  std::size_t count = 0;
  for (const SkinnedPart& part : parts_) count += part.places.size();
  return count;
}

}  // namespace marey::testing
