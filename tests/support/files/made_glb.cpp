// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/made_glb.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace marey::testing {
namespace {

using Json = nlohmann::json;

/// The binary chunk and the accessors into it.
struct Data {
  std::string bin;
  Json views = Json::array();
  Json accessors = Json::array();

  template <class T>
  void put(T value) {
    bin.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::size_t start() {
    while (bin.size() % 4 != 0) bin.push_back('\0');
    return bin.size();
  }
  std::size_t add(std::size_t from, int type, const char* shape, std::size_t count) {
    views.push_back(
        {{"buffer", 0}, {"byteOffset", from}, {"byteLength", bin.size() - from}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", type},
                         {"type", shape},
                         {"count", count}});
    return accessors.size() - 1;
  }
};

Json mesh_of(const MadeVertices& mesh, bool byte_weights, Data& data) {
  const std::size_t count = mesh.places.size();
  glm::dvec3 low(1e9);
  glm::dvec3 high(-1e9);
  std::size_t from = data.start();
  for (const glm::dvec3& p : mesh.places) {
    low = glm::min(low, p);
    high = glm::max(high, p);
    for (int i = 0; i < 3; ++i) data.put(static_cast<float>(p[i]));
  }
  const std::size_t positions = data.add(from, 5126, "VEC3", count);
  data.accessors[positions]["min"] = {low.x, low.y, low.z};
  data.accessors[positions]["max"] = {high.x, high.y, high.z};
  from = data.start();
  for (const auto& carriers : mesh.carriers) {
    for (const auto& carrier : carriers) {
      data.put(static_cast<std::uint8_t>(carrier.first));
    }
    data.put(std::uint8_t{0});
  }
  const std::size_t joints = data.add(from, 5121, "VEC4", count);
  from = data.start();
  for (const auto& carriers : mesh.carriers) {
    // The first takes what rounding leaves of the others.
    std::array<int, 3> bytes{255, 0, 0};
    for (std::size_t k = 1; k < 3; ++k) {
      bytes[k] = static_cast<int>(std::floor(255.0 * carriers[k].second));
      bytes[0] -= bytes[k];
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (byte_weights) {
        data.put(static_cast<std::uint8_t>(k < 3 ? bytes[k] : 0));
      } else {
        data.put(static_cast<float>(k < 3 ? carriers[k].second : 0.0));
      }
    }
  }
  const std::size_t weights = data.add(from, byte_weights ? 5121 : 5126, "VEC4", count);
  if (byte_weights) data.accessors[weights]["normalized"] = true;
  from = data.start();
  for (const unsigned v : mesh.triangles) data.put(static_cast<std::uint32_t>(v));
  const std::size_t indices = data.add(from, 5125, "SCALAR", mesh.triangles.size());
  return {{"primitives",
           {{{"attributes",
              {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
             {"indices", indices}}}}};
}

void put_chunk(std::ofstream& out, const char* kind, const std::string& bytes) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  out.write(reinterpret_cast<const char*>(&size), 4);
  out.write(kind, 4);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

void write_made_glb(const MadeGlb& glb, const std::filesystem::path& path) {
  Data data;
  Json nodes = Json::array();
  for (const MadeNode& node : glb.nodes) {
    nodes.push_back(
        {{"name", node.name},
         {"translation", {node.translation.x, node.translation.y, node.translation.z}},
         {"rotation",
          {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w}}});
    if (node.scale != 1.0) nodes.back()["scale"] = {node.scale, node.scale, node.scale};
  }
  Json joints = Json::array();
  for (std::size_t i = 1; i < glb.nodes.size(); ++i) {
    nodes[static_cast<std::size_t>(glb.nodes[i].parent)]["children"].push_back(i);
    joints.push_back(i);
  }
  std::size_t from = data.start();
  for (const glm::dmat4& m : glb.inverse_bind) {
    for (int k = 0; k < 16; ++k) data.put(static_cast<float>(m[k / 4][k % 4]));
  }
  const std::size_t binds = data.add(from, 5126, "MAT4", glb.inverse_bind.size());
  Json meshes = Json::array();
  Json skins = Json::array();
  Json scene = Json::array({0});
  for (const MadeVertices& mesh : glb.meshes) {
    meshes.push_back(mesh_of(mesh, glb.byte_weights, data));
    skins.push_back({{"joints", joints}, {"inverseBindMatrices", binds}});
    nodes.push_back({{"name", "Body" + std::to_string(meshes.size())},
                     {"mesh", meshes.size() - 1},
                     {"skin", skins.size() - 1}});
    scene.push_back(nodes.size() - 1);
  }
  data.start();
  const Json json{{"asset", {{"version", "2.0"}}},
                  {"scene", 0},
                  {"scenes", {{{"nodes", scene}}}},
                  {"nodes", nodes},
                  {"meshes", meshes},
                  {"skins", skins},
                  {"bufferViews", data.views},
                  {"accessors", data.accessors},
                  {"buffers", {{{"byteLength", data.bin.size()}}}}};
  std::string text = json.dump();
  while (text.size() % 4 != 0) text.push_back(' ');
  std::ofstream out(path, std::ios::binary);
  const std::uint32_t header[3]{
      0x46546C67U, 2U, static_cast<std::uint32_t>(28 + text.size() + data.bin.size())};
  out.write(reinterpret_cast<const char*>(header), 12);
  put_chunk(out, "JSON", text);
  put_chunk(out, std::string("BIN\0", 4).c_str(), data.bin);
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace marey::testing
