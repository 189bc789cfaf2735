// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/character_file.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/degrees.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings {
namespace {

constexpr Limits kStature{0.1, 10.0, "m"};
constexpr Limits kTotalMass{0.01, 1000.0, "kg"};
constexpr Limits kMass{0.0, 1000.0, "kg"};
constexpr Limits kAngle{0.0, 180.0, "degrees"};
constexpr double kMaxDistance_m = 1e4;

struct TableWord {
  MassTable table;
  std::string_view word;
};
constexpr std::array<TableWord, 4> kTables{{{MassTable::kDeLeva, "deleva"},
                                            {MassTable::kDempster, "dempster"},
                                            {MassTable::kDeLevaFemale, "deleva-female"},
                                            {MassTable::kDeLevaMale, "deleva-male"}}};

// Returns degrees that convert back to the same angle, short numbers first.
double degrees(double rad) {
  const double near = rad / kRadiansPerDegree;
  const double rounded = std::round(near * 1e9) / 1e9;
  for (const double deg :
       {rounded, near, std::nextafter(near, -1e9), std::nextafter(near, 1e9)}) {
    if (deg * kRadiansPerDegree == rad) return deg;
  }
  return near;
}

void write_degrees(TomlWriter& out, std::string_view key, const glm::dvec3& rad) {
  out.numbers(key, {degrees(rad.x), degrees(rad.y), degrees(rad.z)});
}

struct WriteBody {
  TomlWriter& out;
  void operator()(const AverageBody& body) const {
    out.number("stature_m", body.stature_m);
  }
  void operator()(const AvatarBody& body) const { out.text("avatar", body.path); }
  void operator()(const SubjectBody& body) const { out.text("subject", body.path); }
};

void write_masses(TomlWriter& out, const MassSpec& mass) {
  bool has_segments = false;
  for (const MassSegment& segment : kMassSegments) {
    const auto& kg = mass.segment_kg[index(segment.bone)];
    if (!kg) continue;
    if (!has_segments) out.table({"segment_mass_kg"});
    has_segments = true;
    out.number(segment.name, *kg);
  }
}

void read_body(TomlReader& in, CharacterSpec& spec) {
  constexpr std::array<std::string_view, 3> kBodies{"avatar", "subject", "stature_m"};
  std::string_view given;
  for (const std::string_view key : kBodies) {
    if (!in.has(key)) continue;
    if (!given.empty()) {
      in.fail(key,
              in_quotes(key) + " is given together with " + in_quotes(given),
              "keep the one whose lengths the character has");
    }
    given = key;
  }
  if (given.empty()) {
    in.fail("",
            "it does not state whose lengths the character has",
            "give \"avatar\", \"subject\" or \"stature_m\"");
    return;
  }
  if (given == "stature_m") {
    spec.body = AverageBody{in.number(given, kStature)};
    return;
  }
  std::string path = in.text(given);
  if (path.empty()) in.fail(given, "the path is empty", "name the file");
  if (given == "avatar") {
    spec.body = AvatarBody{std::move(path)};
  } else {
    spec.body = SubjectBody{std::move(path)};
  }
}

void read_masses(TomlReader& in, MassSpec& mass) {
  if (in.has("mass_kg")) mass.total_kg = in.number("mass_kg", kTotalMass);
  if (in.has("mass_table")) {
    const std::string word = in.text("mass_table");
    std::vector<std::string_view> words;
    words.reserve(kTables.size());
    bool known = false;
    for (const TableWord& table : kTables) {
      words.push_back(table.word);
      if (table.word != word) continue;
      mass.table = table.table;
      known = true;
    }
    if (!known) {
      in.fail("mass_table", "unknown table " + in_quotes(word), suggestion(word, words));
    }
  }
  if (!in.has("segment_mass_kg")) return;
  TomlReader segments = in.table("segment_mass_kg");
  std::vector<std::string_view> names;
  names.reserve(kMassSegments.size());
  for (const MassSegment& segment : kMassSegments) names.push_back(segment.name);
  segments.allow(names);
  for (const MassSegment& segment : kMassSegments) {
    if (!segments.has(segment.name)) continue;
    mass.segment_kg[index(segment.bone)] = segments.number(segment.name, kMass);
  }
}

glm::dvec3 read_degrees(TomlReader& in, std::string_view key) {
  const std::vector<double> deg = in.numbers(key, 3);
  for (const double angle : deg) {
    if (std::abs(angle) <= 180.0) continue;
    in.fail(key, in_quotes(key) + " is beyond half a turn", "give degrees, -180 to 180");
  }
  return glm::dvec3(deg[0], deg[1], deg[2]) * kRadiansPerDegree;
}

void read_limits(TomlReader in, CharacterTraits& traits) {
  std::vector<std::string_view> keys{"anatomical"};
  for (const HumanBone bone : human_bones()) keys.push_back(name(bone));
  in.allow(keys);
  if (in.has("anatomical")) traits.has_limits = in.boolean("anatomical");
  for (const HumanBone bone : human_bones()) {
    if (!in.has(name(bone))) continue;
    TomlReader limit = in.table(name(bone));
    limit.allow({"min_deg", "max_deg"});
    const BoneLimit read{
        bone, read_degrees(limit, "min_deg"), read_degrees(limit, "max_deg")};
    for (const int axis : {0, 1, 2}) {
      if (read.min_rad[axis] <= read.max_rad[axis]) continue;
      limit.fail(
          "min_deg",
          std::string("about ") + "XYZ"[axis] + " \"min_deg\" is above \"max_deg\"",
          "exchange the two");
    }
    traits.limits.push_back(read);
  }
}

void read_load(TomlReader& in, std::vector<LoadSpec>& loads) {
  in.allow({"name", "segment", "offset_m", "mass_kg"});
  LoadSpec load;
  load.name = in.text("name");
  load.point.segment = in.text("segment");
  if (in.has("offset_m")) {
    const std::vector<double> offset = in.numbers("offset_m", 3);
    load.point.offset_in_t_pose = {offset[0], offset[1], offset[2]};
    for (const double along : offset) {
      if (std::abs(along) <= kMaxDistance_m) continue;
      in.fail("offset_m",
              in_quotes("offset_m") + " is beyond 10 km",
              "give metres from the segment's joint");
    }
  }
  load.mass_kg = in.number("mass_kg", kMass);
  if (load.name.empty()) in.fail("name", "the name is empty", "name the load");
  if (load.point.segment.empty()) {
    in.fail("segment", "the segment is empty", "name the bone that carries it");
  }
  for (const LoadSpec& other : loads) {
    if (other.name != load.name) continue;
    in.fail("name", "another load has this name", "give each a name of its own");
  }
  loads.push_back(std::move(load));
}

// Makes a path relative to the working folder.
void resolve(const std::filesystem::path& folder, std::string& path) {
  path = (folder / path).lexically_normal().string();
}

}  // namespace

std::string character_spec_text(const CharacterSpec& spec) {
  const CharacterTraits& traits = spec.traits;
  TomlWriter out;
  out.comment("A character. Metres, kilograms; angles in degrees from the T-pose that");
  out.comment("faces +Z, about its axes (Y up).");
  out.integer("format", 1);
  out.text("name", spec.name);
  std::visit(WriteBody{out}, spec.body);
  if (traits.mass.total_kg) out.number("mass_kg", *traits.mass.total_kg);
  for (const TableWord& table : kTables) {
    if (table.table == traits.mass.table) out.text("mass_table", table.word);
  }
  write_masses(out, traits.mass);
  out.table({"limits"});
  out.boolean("anatomical", traits.has_limits);
  for (const BoneLimit& limit : traits.limits) {
    out.table({"limits", name(limit.bone)});
    write_degrees(out, "min_deg", limit.min_rad);
    write_degrees(out, "max_deg", limit.max_rad);
  }
  out.table({"flexibility"});
  out.number("least_trunk_thigh_deg",
             degrees(traits.flexibility.min_trunk_thigh_angle_rad));
  out.number("straight_knee_deg", degrees(traits.flexibility.straight_knee_rad));
  for (const LoadSpec& load : traits.loads) {
    const glm::dvec3& offset = load.point.offset_in_t_pose;
    out.array_table("load");
    out.text("name", load.name);
    out.text("segment", load.point.segment);
    out.numbers("offset_m", {offset.x, offset.y, offset.z});
    out.number("mass_kg", load.mass_kg);
  }
  return out.str();
}

Status write_character_spec(const std::filesystem::path& path,
                            const CharacterSpec& spec) {
  return write_file(path, character_spec_text(spec));
}

Result<CharacterSpec> parse_character_spec(std::string_view text,
                                           const std::string& file) {
  Result<TomlDocument> document = parse_toml(text, file, "character.md");
  if (!document) return document.error();
  TomlReader root(*document);
  root.allow({"format",
              "name",
              "avatar",
              "subject",
              "stature_m",
              "mass_kg",
              "mass_table",
              "segment_mass_kg",
              "limits",
              "flexibility",
              "load"});
  (void)root.integer("format", {1, 1});
  CharacterSpec spec;
  spec.name = root.text("name");
  read_body(root, spec);
  read_masses(root, spec.traits.mass);
  if (root.has("limits")) read_limits(root.table("limits"), spec.traits);
  if (root.has("flexibility")) {
    TomlReader in = root.table("flexibility");
    in.allow({"least_trunk_thigh_deg", "straight_knee_deg"});
    Flexibility& flexibility = spec.traits.flexibility;
    if (in.has("least_trunk_thigh_deg")) {
      flexibility.min_trunk_thigh_angle_rad =
          in.number("least_trunk_thigh_deg", kAngle) * kRadiansPerDegree;
    }
    if (in.has("straight_knee_deg")) {
      flexibility.straight_knee_rad =
          in.number("straight_knee_deg", kAngle) * kRadiansPerDegree;
    }
  }
  for (TomlReader& load : root.tables("load")) read_load(load, spec.traits.loads);
  if (document->mistake) return mistake_of(*document, TomlKind::kCharacter);
  return spec;
}

Result<CharacterSpec> read_character_spec(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  Result<CharacterSpec> spec = parse_character_spec(*text, path.string());
  if (!spec) return spec.error();
  if (auto* avatar = std::get_if<AvatarBody>(&(*spec).body)) {
    resolve(path.parent_path(), avatar->path);
  } else if (auto* subject = std::get_if<SubjectBody>(&(*spec).body)) {
    resolve(path.parent_path(), subject->path);
  }
  return spec;
}

}  // namespace marey::recordings
