// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <utility>

#include "tests/support/files/bombs.h"

namespace marey::testing {
namespace {

void put(std::string& bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    bytes[at + i] = static_cast<char>((value >> (8 * i)) & 0xffU);
  }
}

/// Two blocks: a header that promises everything, and no parameters.
std::string c3d(std::uint16_t points, std::uint16_t analog, std::uint16_t per_frame) {
  std::string bytes(1024, '\0');
  bytes[0] = 2;
  bytes[1] = 0x50;
  put(bytes, 2, points, 2);
  put(bytes, 4, analog, 2);
  put(bytes, 6, 1, 2);
  put(bytes, 8, 65535, 2);
  put(bytes, 12, 0xbf800000U, 4);  // -1: real numbers.
  put(bytes, 16, 3, 2);
  put(bytes, 18, per_frame, 2);
  put(bytes, 20, 0x42c80000U, 4);  // 100 Hz.
  bytes[512 + 2] = 1;
  bytes[512 + 3] = 84;
  return bytes;
}

/// A ZIP entry's two headers, without compression and without a checksum.
struct Entry {
  std::string name;
  std::string content;
  std::uint64_t stated_size = 0;  ///< Size in the directory's row.
  std::uint64_t method = 0;
};

std::string zip(const std::vector<Entry>& entries) {
  std::string bytes;
  std::string directory;
  for (const Entry& entry : entries) {
    std::string local(30, '\0');
    put(local, 0, 0x04034b50, 4);
    put(local, 26, entry.name.size(), 2);
    std::string row(46, '\0');
    put(row, 0, 0x02014b50, 4);
    put(row, 10, entry.method, 2);
    put(row, 20, entry.stated_size, 4);
    put(row, 24, entry.stated_size, 4);
    put(row, 28, entry.name.size(), 2);
    put(row, 42, bytes.size(), 4);
    bytes += local + entry.name + entry.content;
    directory += row + entry.name;
  }
  std::string end(22, '\0');
  put(end, 0, 0x06054b50, 4);
  put(end, 8, entries.size(), 2);
  put(end, 10, entries.size(), 2);
  put(end, 12, directory.size(), 4);
  put(end, 16, bytes.size(), 4);
  return bytes + directory + end;
}

std::string npy(const std::string& type, const std::string& shape) {
  std::string head =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  head.append(117 - head.size() % 118, ' ');
  head += '\n';
  std::string bytes("\x93NUMPY\x01\x00\x00\x00", 10);
  put(bytes, 8, head.size(), 2);
  return bytes + head;
}

Entry array(const std::string& name, const std::string& content) {
  return {name + ".npy", content, content.size()};
}

}  // namespace

std::vector<Bomb> toml_bombs() {
  std::vector<Bomb> bombs;
  const std::string key = repeated("a.", 18'000) + "a";
  bombs.push_back({"key.toml", key + " = 1\n"});
  bombs.push_back({"spaced_key.toml", repeated("a . ", 18'000) + "a = 1\n"});
  bombs.push_back({"quoted_key.toml", repeated("\"a\".", 18'000) + "a = 1\n"});
  bombs.push_back({"header.toml", "[" + key + "]\nb = 1\n"});
  bombs.push_back({"list_header.toml", "[[" + key + "]]\nb = 1\n"});
  bombs.push_back({"lists.toml", "a = " + nested("[", "1", "]", 20'000) + "\n"});
  bombs.push_back({"tables.toml", "a = " + nested("{a = ", "1", "}", 20'000) + "\n"});
  bombs.push_back(
      {"both.toml",
       "a = " + nested("{" + repeated("a.", 90) + "a = ", "1", "}", 200) + "\n"});
  std::string many;
  for (int i = 0; i < 200'000; ++i) many += "k" + std::to_string(i) + " = 1\n";
  bombs.push_back({"keys.toml", many});
  std::string headers;
  for (int i = 0; i < 200'000; ++i) headers += "[k" + std::to_string(i) + "]\na = 1\n";
  bombs.push_back({"headers_many.toml", headers});
  std::string tables;
  for (int i = 0; i < 100'000; ++i) tables += "[camera.c" + std::to_string(i) + "]\n";
  bombs.push_back({"tables_many.toml", tables});
  std::string listed_tables;
  for (int i = 0; i < 200'000; ++i) listed_tables += "[[camera]]\nname = \"a\"\n";
  bombs.push_back({"lists_many.toml", listed_tables});
  std::string labels = "[markers]\n";
  for (int i = 0; i < 200'000; ++i) {
    labels += "k" + std::to_string(i) + " = \"left_asis\"\n";
  }
  bombs.push_back({"labels.toml", labels, true});
  std::string numbers = "a = [";
  for (int i = 0; i < 300'000; ++i) numbers += "1, ";
  bombs.push_back({"numbers.toml", numbers + "1]\n"});
  bombs.push_back(
      {"long_text.toml", "a = \"\"\"" + repeated("[[a.b.", 100'000) + "\"\"\"\n"});
  bombs.push_back({"long_key.toml", std::string(3'000'000, 'k') + " = 1\n"});
  return bombs;
}

std::vector<Bomb> tree_bombs() {
  std::vector<Bomb> bombs;
  bombs.push_back({"lists.yaml", "a: " + nested("[", "1", "]", 20'000) + "\n"});
  bombs.push_back({"maps.yaml", "a: " + nested("{a: ", "1", "}", 20'000) + "\n"});
  std::string indented;
  for (std::size_t i = 0; i < 2'000; ++i) indented += std::string(i, ' ') + "a:\n";
  bombs.push_back({"indented.yaml", indented});
  std::string laughs = "a0: &a0 [1, 1]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last + ", " +
              last + "]\n";
  }
  bombs.push_back({"references.yaml", laughs});
  std::string keys;
  for (int i = 0; i < 50'000; ++i) keys += "k" + std::to_string(i) + ": 1\n";
  bombs.push_back({"keys.yaml", keys});
  const auto storage = [](const std::string& inner) {
    return "<?xml version=\"1.0\"?>\n<opencv_storage>\n" + inner + "</opencv_storage>\n";
  };
  bombs.push_back({"deep.xml", storage(nested("<a>", "1", "</a>", 100'000))});
  bombs.push_back({"elements.xml", storage(repeated("<a>1</a>\n", 300'000))});
  const auto constraints = [](const std::string& inner) {
    return "<ConstraintsSet>\n" + inner + "</ConstraintsSet>\n";
  };
  bombs.push_back(
      {"deep.constraints", constraints(nested("<a>", "1", "</a>", 100'000)), true});
  bombs.push_back({"elements.constraints",
                   constraints(repeated("<Support><name>a</name></Support>\n", 50'000))});
  bombs.push_back({"attributes.constraints",
                   constraints("<a " +
                               listed(100'000,
                                      [](std::size_t i) {
                                        return "b" + std::to_string(i) + "=\"1\"";
                                      }) +
                               "/>\n")});
  return bombs;
}

std::vector<Bomb> table_bombs() {
  std::vector<Bomb> bombs;
  bombs.push_back({"promises.c3d", c3d(65535, 65535, 65535)});
  bombs.push_back({"analog.c3d", c3d(0, 65535, 1)});
  const std::string trc_head =
      "PathFileType\t4\t(X/Y/"
      "Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n";
  bombs.push_back({"promises.trc",
                   trc_head + "100\t100\t1000000000\t1000000000\tmm\n"
                              "Frame#\tTime\tA\n\t\tX1\tY1\tZ1\n1\t0\t1\t2\t3\n",
                   true});
  bombs.push_back({"columns.trc",
                   trc_head + "100\t100\t1\t1000000\tmm\nFrame#\tTime" +
                       repeated("\tA\t\t", 1'000'000) + "\n\n1\t0\t1\t2\t3\n",
                   true});
  bombs.push_back({"hole.trc",
                   trc_head + "100\t100\t2\t1\tmm\nFrame#\tTime\tA\n\t\tX1\tY1\tZ1\n"
                              "1\t0\t1\t2\t3\n900000000\t8999999.99\t1\t2\t3\n"});
  bombs.push_back(
      {"columns.mot",
       "a\nversion=1\nnRows=1\nnColumns=2000000\ninDegrees=yes\nendheader\ntime" +
           repeated("\tc", 2'000'000) + "\n0\t1\n"});
  bombs.push_back({"promises.mot",
                   "a\nversion=1\nnRows=2000000000\nnColumns=2000000000\ninDegrees=yes\n"
                   "endheader\ntime\tc\n0\t1\n",
                   true});
  bombs.push_back({"long_line.csv", std::string(20'000'000, ',')});
  bombs.push_back(
      {"columns.csv",
       "frame,time,joint,x,y,z,sigma\n1,0,a,1,2,3,4" + repeated(",5", 2'000'000) + "\n"});
  return bombs;
}

std::vector<Bomb> npz_bombs() {
  std::vector<Bomb> bombs;
  const std::string empty = npy("<f8", "()");
  const auto motion = [&](const std::string& names, std::vector<Entry> more) {
    std::vector<Entry> entries{
        array("format", npy("<i8", "()") + std::string("\1\0\0\0\0\0\0\0", 8)),
        array("joint_names", names),
        array("rotations_wxyz", empty)};
    entries.insert(entries.end(), more.begin(), more.end());
    return zip(entries);
  };
  bombs.push_back({"shape.npz", motion(npy("<U1", "(2000000000,)"), {})});
  bombs.push_back(
      {"product.npz", motion(npy("<U1", "(2147483647, 2147483647, 2147483647)"), {})});
  bombs.push_back({"letters.npz", motion(npy("<U2000000000", "(1,)"), {})});
  bombs.push_back({"declared.npz", zip({{"format.npy", "", 4'000'000'000, 0}})});
  bombs.push_back({"compressed.npz",
                   zip({{"format.npy", "xx", 2, 8},
                        {"joint_names.npy", "xx", 2, 8},
                        {"rotations_wxyz.npy", "xx", 2, 8}})});
  std::vector<Entry> many;
  for (int i = 0; i < 60'000; ++i) many.push_back(array("a" + std::to_string(i), ""));
  bombs.push_back({"entries.npz", zip(many)});
  bombs.push_back(
      {"quotes.npz", motion(npy("<U1" + std::string(40, ' '), "(((((((("), {})});
  return bombs;
}

std::vector<Bomb> json_bombs() {
  std::vector<Bomb> bombs;
  const auto report = [](const std::string& value) {
    return "{\"summary\":" + value + "}";
  };
  bombs.push_back({"deep_lists.json", report(nested("[", "1", "]", 68'000))});
  bombs.push_back({"deep_objects.json", report(nested("{\"a\":", "1", "}", 68'000))});
  bombs.push_back({"open.json", repeated("[", 1'000'000)});
  bombs.push_back({"many_keys.json", "{" + listed(200'000, [](std::size_t i) {
                                       return "\"k" + std::to_string(i) + "\":1";
                                     }) + "}"});
  bombs.push_back({"no_report.json", "[" + listed(200'000, [](std::size_t) {
                                       return std::string("1");
                                     }) + "]"});
  return bombs;
}

}  // namespace marey::testing
