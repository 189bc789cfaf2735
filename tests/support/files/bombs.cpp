// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/bombs.h"

#include <cstdint>
#include <utility>

namespace marey::testing {
namespace {

std::string gltf(const std::string& members) {
  return "{\"asset\":{\"version\":\"2.0\"}," + members + "}";
}

/// A triangle on a skin of one joint whose vertices are one accessor of `count` zeros,
/// shared by `primitives` and by `nodes`.
std::string shared_mesh(std::size_t count, std::size_t primitives, std::size_t nodes) {
  const std::string bytes = std::to_string(12 * count);
  const std::string n = std::to_string(count);
  // Zeros in base64.
  const std::string data((12 * count + 2) / 3 * 4, 'A');
  std::string text = "\"buffers\":[{\"byteLength\":" + bytes +
                     ",\"uri\":\"data:application/octet-stream;base64," + data +
                     "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":" + bytes +
                     "}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
                     "\"type\":\"VEC3\",\"count\":" +
                     n + ",\"min\":[0,0,0],\"max\":[0,0,0]}],";
  text +=
      "\"meshes\":[{\"primitives\":[" +
      listed(
          primitives,
          [](std::size_t) { return std::string("{\"attributes\":{\"POSITION\":0}}"); }) +
      "]}],\"skins\":[{\"joints\":[0]}],\"nodes\":[{\"name\":\"hips\"}," +
      listed(nodes, [](std::size_t) { return std::string("{\"mesh\":0,\"skin\":0}"); }) +
      "]";
  return gltf(text);
}

/// An animation of two keys, a year apart or nearly so, on `channels` channels.
std::string long_animation(std::size_t channels, std::size_t nodes) {
  // Times 0 and 30000 s as floats, then two unit quaternions.
  const std::string data = "AAAAAABg6kYAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPw==";
  return gltf(
      "\"buffers\":[{\"byteLength\":40,\"uri\":\"data:application/octet-stream;base64," +
      data +
      "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":8},{\"buffer\":0,"
      "\"byteOffset\":8,\"byteLength\":32}],\"accessors\":[{\"bufferView\":0,"
      "\"componentType\":5126,\"type\":\"SCALAR\",\"count\":2,\"min\":[0],\"max\":[30000]"
      "},"
      "{\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC4\",\"count\":2}],"
      "\"animations\":[{\"samplers\":[{\"input\":0,\"output\":1}],\"channels\":[" +
      listed(channels,
             [](std::size_t) {
               return std::string(
                   "{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"rotation\"}}");
             }) +
      "]}],\"skins\":[{\"joints\":[0]}],\"nodes\":[{\"name\":\"hips\"}," +
      listed(nodes, [](std::size_t) { return std::string("{}"); }) + "]");
}

std::string node_chain(std::size_t nodes) {
  return gltf("\"nodes\":[" +
              listed(nodes,
                     [&](std::size_t i) {
                       return i + 1 < nodes
                                  ? "{\"children\":[" + std::to_string(i + 1) + "]}"
                                  : std::string("{}");
                     }) +
              "]");
}

std::string image_beyond_its_buffer() {
  return gltf(
      "\"buffers\":[{\"byteLength\":3,\"uri\":\"data:application/octet-stream;base64,"
      "AAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":2000000000}],"
      "\"images\":[{\"bufferView\":0,\"mimeType\":\"image/png\"}],\"nodes\":[{}]");
}

std::string many_images(std::size_t images) {
  const std::string data(40000, 'A');
  return gltf(
      "\"buffers\":[{\"byteLength\":30000,\"uri\":\"data:application/"
      "octet-stream;base64," +
      data + "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":30000}],\"images\":[" +
      listed(images,
             [](std::size_t) {
               return std::string("{\"bufferView\":0,\"mimeType\":\"image/png\"}");
             }) +
      "],\"nodes\":[{}]");
}

std::string bvh_joint(const std::string& name) {
  return "JOINT " + name +
         "\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
}

std::string bvh(const std::string& joints, const std::string& motion) {
  return "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation "
         "Yrotation\n" +
         joints + "}\n" + motion;
}

constexpr const char* kNoFrames = "MOTION\nFrames: 0\nFrame Time: 0.01\n";

/// Bones b0, b1... of which each hangs on the one that `parent` names.
template <class Parent>
std::string asf(std::size_t bones, const Parent& parent) {
  std::string text =
      ":version 1.10\n:name a\n:units\nmass 1\nlength 1\nangle deg\n:root\n"
      "order TX TY TZ RX RY RZ\naxis XYZ\nposition 0 0 0\norientation 0 0 0\n:bonedata\n";
  std::string hierarchy = ":hierarchy\nbegin\n";
  for (std::size_t i = 0; i < bones; ++i) {
    const std::string name = "b" + std::to_string(i);
    text +=
        "begin\nname " + name + "\ndirection 0 1 0\nlength 0.01\naxis 0 0 0 XYZ\nend\n";
    hierarchy += (i == 0 ? "root" : "b" + std::to_string(parent(i))) + " " + name + "\n";
  }
  return text + hierarchy + "end\n";
}

}  // namespace

std::string repeated(const std::string& text, std::size_t count) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += text;
  return out;
}

std::string nested(const std::string& open,
                   const std::string& middle,
                   const std::string& close,
                   std::size_t depth) {
  return repeated(open, depth) + middle + repeated(close, depth);
}

std::vector<Bomb> gltf_bombs() {
  std::vector<Bomb> bombs;
  const auto extras = [](const std::string& value) {
    return gltf("\"nodes\":[{\"name\":\"hips\",\"extras\":" + value + "}]");
  };
  bombs.push_back({"deep_lists.gltf", extras(nested("[", "1", "]", 15'000))});
  bombs.push_back({"deep_objects.gltf", extras(nested("{\"a\":", "1", "}", 15'000))});
  bombs.push_back({"deep_open.gltf", "{\"asset\":" + repeated("[", 300'000)});
  bombs.push_back({"quotes.gltf", "{\"a\\\"[[[\":" + repeated("[", 300'000)});
  bombs.push_back({"node_chain.gltf", node_chain(50'000)});
  bombs.push_back(
      {"many_joints.gltf",
       gltf("\"nodes\":[{\"children\":[" +
            listed(100'000, [](std::size_t i) { return std::to_string(i + 1); }) + "]}," +
            listed(100'000, [](std::size_t) { return std::string("{}"); }) + "]")});
  bombs.push_back({"shared_by_primitives.gltf", shared_mesh(20'000, 20'000, 1)});
  bombs.push_back({"shared_by_nodes.gltf", shared_mesh(20'000, 1, 20'000)});
  bombs.push_back({"empty_primitives.gltf", shared_mesh(1, 20'000, 20'000)});
  bombs.push_back({"long_animation.gltf", long_animation(20'000, 1), true});
  bombs.push_back({"many_still_nodes.gltf", long_animation(1, 100'000), true});
  bombs.push_back({"image_beyond.gltf", image_beyond_its_buffer()});
  bombs.push_back({"many_images.gltf", many_images(60'000)});
  bombs.push_back(
      {"count.gltf",
       gltf("\"buffers\":[{\"byteLength\":3,\"uri\":\"data:application/"
            "octet-stream;base64,AAAA\"}],\"bufferViews\":[{\"buffer\":0,"
            "\"byteLength\":3}],\"accessors\":[{\"bufferView\":0,"
            "\"componentType\":5126,\"type\":\"VEC3\",\"count\":"
            "4000000000000000000}],\"meshes\":[{\"primitives\":[{"
            "\"attributes\":{\"POSITION\":0}}]}],\"skins\":[{\"joints\":[0]}],"
            "\"nodes\":[{\"mesh\":0,\"skin\":0}]")});
  bombs.push_back({"long_name.gltf",
                   gltf("\"nodes\":[{\"name\":\"" + std::string(3'000'000, 'x') + "\"}]"),
                   true});
  return bombs;
}

std::vector<Bomb> skeleton_bombs() {
  std::vector<Bomb> bombs;
  const std::string end = "End Site\n{\nOFFSET 0 1 0\n}\n";
  bombs.push_back(
      {"deep.bvh", bvh(nested(bvh_joint("j"), end, "}\n", 30'000), kNoFrames)});
  bombs.push_back({"open.bvh", bvh(repeated(bvh_joint("j"), 30'000), "")});
  bombs.push_back(
      {"wide.bvh", bvh(repeated(bvh_joint("j") + end + "}\n", 100'000), kNoFrames)});
  bombs.push_back(
      {"frames.bvh", bvh(end, "MOTION\nFrames: 2000000000\nFrame Time: 0.01\n0 0 0\n")});
  bombs.push_back({"long_name.bvh",
                   bvh(bvh_joint(std::string(5'000'000, 'n')) + end + "}\n", kNoFrames),
                   true});
  bombs.push_back(
      {"long_line.bvh",
       bvh(end, "MOTION\nFrames: 1\nFrame Time: 0.01\n" + repeated("0 ", 2'000'000))});
  bombs.push_back({"chain.asf", asf(22'000, [](std::size_t i) { return i - 1; })});
  bombs.push_back({"wide.asf", asf(100'000, [](std::size_t) { return std::size_t{0}; })});
  bombs.push_back(
      {"comb.asf",
       asf(20'000, [](std::size_t i) { return i < 900 ? i - 1 : (i - 900) % 900; }),
       true});
  bombs.push_back({"names.asf",
                   asf(3, [](std::size_t i) { return i - 1; }) + ":bonedata\n" +
                       repeated("begin\nname x\n", 100'000)});
  return bombs;
}

}  // namespace marey::testing
