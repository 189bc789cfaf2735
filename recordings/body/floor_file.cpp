// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/floor_file.h"

#include <array>
#include <cmath>
#include <utility>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings {
namespace {

constexpr double kFar_m = 1e4;
constexpr Limits kHeight{-kFar_m, kFar_m, "m"};
constexpr double kMaxSlope = 1.7320508075688772;  // Slope of 60 degrees.
constexpr double kMaxTime_s = 1e6;

void check_far(TomlReader& in, std::string_view key, const std::vector<double>& places) {
  for (const double p : places) {
    if (std::abs(p) <= kFar_m) continue;
    in.fail(key, in_quotes(key) + " is more than 10 km away", "give metres");
  }
}

// Reads [minimum, maximum].
std::array<double, 2> read_side(TomlReader& in, std::string_view key) {
  const std::vector<double> ends = in.numbers(key, 2);
  check_far(in, key, ends);
  if (ends[0] >= ends[1]) {
    in.fail(key,
            in_quotes(key) + " has no length",
            "give the lesser end, then the greater, in metres");
  }
  return {ends[0], ends[1]};
}

void read_top(TomlReader& in, FloorPart& part) {
  constexpr std::array<std::string_view, 3> kTops{"top_m", "ramp_x_m", "ramp_z_m"};
  int given = 0;
  for (const std::string_view key : kTops) given += in.has(key) ? 1 : 0;
  if (given != 1) {
    in.fail("",
            given == 0 ? "a part has no height" : "a part has more than one height",
            "give one of \"top_m\", \"ramp_x_m\" and \"ramp_z_m\"");
    return;
  }
  if (in.has("top_m")) {
    part.height_m = in.number("top_m", kHeight);
    return;
  }
  const int axis = in.has("ramp_x_m") ? 0 : 1;
  const std::string_view key = kTops[static_cast<std::size_t>(axis) + 1];
  const std::vector<double> edges = in.numbers(key, 2);
  check_far(in, key, edges);
  if (!in.ok()) return;
  part.height_m = 0.5 * (edges[0] + edges[1]);
  part.slope[axis] = (edges[1] - edges[0]) / (part.max_xz_m[axis] - part.min_xz_m[axis]);
  if (std::abs(part.slope[axis]) <= kMaxSlope) return;
  in.fail(key,
          in_quotes(key) + " is steeper than 60 degrees",
          "make the ramp longer or lower; no foot stands on it");
}

void read_path(TomlReader& in, FloorPart& part) {
  if (!in.has("times_s") && !in.has("moved_m")) return;
  const std::size_t count = in.count("times_s");
  const std::vector<double> times = in.numbers("times_s", count);
  const std::vector<double> moved = in.matrix("moved_m", count, 3);
  check_far(in, "moved_m", moved);
  for (std::size_t k = 0; k < count; ++k) {
    if (std::abs(times[k]) > kMaxTime_s) {
      in.fail("times_s", "\"times_s\" is beyond a million seconds", "give seconds");
    }
    if (k > 0 && times[k] <= times[k - 1]) {
      in.fail("times_s", "\"times_s\" does not ascend", "give each time once, in order");
    }
    part.path.push_back({times[k], {moved[3 * k], moved[3 * k + 1], moved[3 * k + 2]}});
  }
}

void read_part(TomlReader& in, std::vector<FloorPart>& parts) {
  in.allow({"name", "x_m", "z_m", "top_m", "ramp_x_m", "ramp_z_m", "times_s", "moved_m"});
  FloorPart part;
  part.name = in.text("name");
  if (part.name.empty()) in.fail("name", "the name is empty", "name the part");
  for (const FloorPart& other : parts) {
    if (other.name != part.name) continue;
    in.fail("name", "another part has this name", "give each a name of its own");
  }
  const std::array<double, 2> x = read_side(in, "x_m");
  const std::array<double, 2> z = read_side(in, "z_m");
  part.min_xz_m = {x[0], z[0]};
  part.max_xz_m = {x[1], z[1]};
  read_top(in, part);
  read_path(in, part);
  parts.push_back(std::move(part));
}

void write_part(TomlWriter& out, const FloorPart& part) {
  out.array_table("part");
  out.text("name", part.name);
  out.numbers("x_m", {part.min_xz_m.x, part.max_xz_m.x});
  out.numbers("z_m", {part.min_xz_m.y, part.max_xz_m.y});
  const glm::dvec2 rise_m = 0.5 * part.slope * (part.max_xz_m - part.min_xz_m);
  if (rise_m.x != 0.0) {
    out.numbers("ramp_x_m", {part.height_m - rise_m.x, part.height_m + rise_m.x});
  } else if (rise_m.y != 0.0) {
    out.numbers("ramp_z_m", {part.height_m - rise_m.y, part.height_m + rise_m.y});
  } else {
    out.number("top_m", part.height_m);
  }
  if (part.path.empty()) return;
  std::vector<double> times;
  std::vector<double> moved;
  for (const FloorKey& key : part.path) {
    times.push_back(key.time_s);
    for (const int axis : {0, 1, 2}) moved.push_back(key.moved_m[axis]);
  }
  out.numbers("times_s", times);
  out.matrix("moved_m", moved, 3);
}

}  // namespace

std::string floor_text(const Floor& floor) {
  TomlWriter out;
  out.comment("A floor. Metres from the level floor on which the motion was made, Y up.");
  out.integer("format", 1);
  out.number("base_m", floor.base_height_m);
  for (const FloorPart& part : floor.parts) write_part(out, part);
  return out.str();
}

Result<Floor> parse_floor(std::string_view text, const std::string& file) {
  Result<TomlDocument> document = parse_toml(text, file, "floor.md");
  if (!document) return document.error();
  TomlReader root(*document);
  root.allow({"format", "base_m", "part"});
  (void)root.integer("format", {1, 1});
  Floor floor;
  if (root.has("base_m")) floor.base_height_m = root.number("base_m", kHeight);
  for (TomlReader& part : root.tables("part")) read_part(part, floor.parts);
  if (document->mistake) return mistake_of(*document, TomlKind::kFloor);
  return floor;
}

Result<Floor> read_floor(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_floor(*text, path.string());
}

}  // namespace marey::recordings
