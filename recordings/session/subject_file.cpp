// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/subject_file.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/in_quotes.h"
#include "core/humanoid.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings {
namespace {

constexpr Limits kLength{0.0, 10.0, "m"};
constexpr Limits kAngle{0.0, 10.0, "rad"};
constexpr Limits kSubjectMass{0.0, 1000.0, "kg"};
constexpr Limits kNumber{0, 1e6};
constexpr Limits kPriorCount{0, 2e9};

struct Tip {
  std::string_view key;
  glm::dvec3 Proportions::*p_in_bone;
};

constexpr std::array<Tip, 5> kTips{{
    {"head_top_in_head_m", &Proportions::head_top_in_head},
    {"left_hand_tip_in_hand_m", &Proportions::left_hand_tip_in_hand},
    {"right_hand_tip_in_hand_m", &Proportions::right_hand_tip_in_hand},
    {"left_toe_tip_in_toes_m", &Proportions::left_toe_tip_in_toes},
    {"right_toe_tip_in_toes_m", &Proportions::right_toe_tip_in_toes},
}};

void write_vector(TomlWriter& out, std::string_view key, const glm::dvec3& v) {
  out.numbers(key, {v.x, v.y, v.z});
}

glm::dvec3 read_vector(TomlReader& in, std::string_view key) {
  const std::vector<double> v = in.numbers(key, 3);
  return {v[0], v[1], v[2]};
}

void write_joint(TomlWriter& out, const Body& body, HumanBone bone) {
  const glm::dvec3& offset_in_parent = body.proportions[bone];
  out.table({"joint", name(bone)});
  const std::optional<HumanBone> above = parent(bone);
  out.text("parent", above ? name(*above) : "floor");
  write_vector(out, "offset_in_parent_m", offset_in_parent);
  out.number("length_m", glm::length(offset_in_parent));
  out.number("sigma_m", body.joint_centre_sigma_m[index(bone)]);
}

/// The keys of [hinge], in the order of human_limbs().
constexpr std::array<std::string_view, 4> kHingeKeys{
    "left_elbow", "right_elbow", "left_knee", "right_knee"};

void write_hinges(TomlWriter& out, const Body& body) {
  out.table({"hinge"});
  for (std::size_t limb = 0; limb < kHingeKeys.size(); ++limb) {
    const HingeShape& hinge = body.hinges[limb];
    out.numbers(kHingeKeys[limb], {hinge.upper_rad, hinge.lower_rad, hinge.rollback_m});
  }
}

/// Reads [hinge]. Missing hinges are straight.
void read_hinges(TomlReader& root, Body& body) {
  if (!root.has("hinge")) return;
  TomlReader in = root.table("hinge");
  in.allow(kHingeKeys);
  for (std::size_t limb = 0; limb < kHingeKeys.size(); ++limb) {
    if (!in.has(kHingeKeys[limb])) continue;
    const std::vector<double> shape = in.numbers(kHingeKeys[limb], 3);
    body.hinges[limb] = {shape[0], shape[1], shape[2]};
  }
}

void write_tag(TomlWriter& out, const PlacedTag& placed) {
  const glm::dquat& q = placed.segment_from_tag.rotation;
  out.array_table("tag");
  out.integer("id", number(placed.tag.id));
  out.text("segment", name(placed.tag.segment));
  out.number("size_m", placed.tag.size_m);
  out.numbers("rotation_wxyz", {q.w, q.x, q.y, q.z});
  write_vector(out, "translation_m", placed.segment_from_tag.translation);
  out.number("sigma_m", placed.sigma_m);
  out.number("sigma_rad", placed.sigma_rad);
  out.integer("sightings", placed.sightings);
}

void write_marker(TomlWriter& out, const PlacedMarker& placed) {
  out.array_table("marker");
  out.text("label", placed.label);
  out.text("segment", name(placed.segment));
  write_vector(out, "p_in_segment_m", placed.p_in_segment);
  out.number("sigma_m", placed.sigma_m);
  out.number("stray_m", placed.stray_m);
  out.integer("frames", placed.frames);
}

void write_warning(TomlWriter& out, const Finding& warning) {
  out.array_table("doubt");
  out.text("cause", warning.cause);
  out.text("next", warning.next);
}

void read_warning(TomlReader& in, Body& body) {
  in.allow({"cause", "next"});
  std::string cause = in.text("cause");
  body.warnings.push_back(fair_finding("", "", std::move(cause), in.text("next")));
}

void read_joint(TomlReader& in, HumanBone bone, Body& body) {
  in.allow({"parent", "offset_in_parent_m", "length_m", "sigma_m"});
  const std::optional<HumanBone> above = parent(bone);
  const std::string_view expected = above ? name(*above) : "floor";
  if (in.has("parent") && in.text("parent") != expected) {
    in.fail("parent",
            "the parent must be " + in_quotes(expected),
            "marey's skeleton is fixed: write it so, or remove the line");
  }
  body.proportions[bone] = read_vector(in, "offset_in_parent_m");
  body.joint_centre_sigma_m[index(bone)] = in.number("sigma_m", kLength);
  if (!in.has("length_m")) return;
  constexpr double kTolerance = 1e-6;  // May have been rounded by hand. [m]
  const double length_m = glm::length(body.proportions[bone]);
  if (std::abs(in.number("length_m", kLength) - length_m) > kTolerance) {
    in.fail("length_m",
            "\"length_m\" is not the length of \"offset_in_parent_m\"",
            "change offset_in_parent_m, which counts, and remove length_m");
  }
}

RigidTransform read_placement(TomlReader& in) {
  const std::vector<double> wxyz = in.numbers("rotation_wxyz", 4);
  RigidTransform segment_from_tag;
  segment_from_tag.rotation = glm::dquat(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  segment_from_tag.translation = read_vector(in, "translation_m");
  constexpr double kTolerance = 1e-6;  // May have been rounded by hand.
  if (std::abs(glm::length(segment_from_tag.rotation) - 1.0) > kTolerance) {
    in.fail("rotation_wxyz",
            "\"rotation_wxyz\" is not a unit quaternion",
            "divide it by its length");
  }
  return segment_from_tag;
}

void read_tag(TomlReader& in, Body& body) {
  in.allow({"id",
            "segment",
            "size_m",
            "rotation_wxyz",
            "translation_m",
            "sigma_m",
            "sigma_rad",
            "sightings"});
  PlacedTag placed;
  placed.tag.id = TagId{in.integer("id", kNumber)};
  const std::string segment = in.text("segment");
  placed.tag.size_m = in.number("size_m", kLength);
  placed.segment_from_tag = read_placement(in);
  placed.sigma_m = in.number("sigma_m", kLength);
  placed.sigma_rad = in.number("sigma_rad", kAngle);
  placed.sightings = in.integer("sightings", kPriorCount);
  const std::optional<HumanBone> bone = human_bone(segment);
  if (!bone) {
    in.fail("segment", "unknown segment " + in_quotes(segment), bone_suggestion(segment));
    return;
  }
  placed.tag.segment = *bone;
  for (const PlacedTag& other : body.tags) {
    if (other.tag.id != placed.tag.id) continue;
    in.fail("id", "this tag is listed twice", "remove one, or correct its id");
  }
  body.tags.push_back(placed);
}

void read_marker(TomlReader& in, Body& body) {
  in.allow({"label", "segment", "p_in_segment_m", "sigma_m", "stray_m", "frames"});
  PlacedMarker placed;
  placed.label = in.text("label");
  const std::string segment = in.text("segment");
  placed.p_in_segment = read_vector(in, "p_in_segment_m");
  placed.sigma_m = in.number("sigma_m", kLength);
  placed.stray_m = in.number("stray_m", kLength);
  placed.frames = in.integer("frames", kPriorCount);
  const std::optional<HumanBone> bone = human_bone(segment);
  if (!bone) {
    in.fail("segment", "unknown segment " + in_quotes(segment), bone_suggestion(segment));
    return;
  }
  placed.segment = *bone;
  if (placed.label.empty()) in.fail("label", "the label is empty", "name the marker");
  for (const PlacedMarker& other : body.markers) {
    if (other.label != placed.label) continue;
    in.fail("label", "this marker is listed twice", "remove one, or correct its label");
  }
  body.markers.push_back(std::move(placed));
}

void read_joints(TomlReader root, Body& body) {
  TomlReader joints = root.table("joint");
  for (const std::string& key : joints.keys()) {
    if (human_bone(key)) continue;
    joints.fail(key, "unknown joint " + in_quotes(key), bone_suggestion(key));
  }
  for (const HumanBone bone : human_bones()) {
    TomlReader joint = joints.table(name(bone));
    read_joint(joint, bone, body);
  }
}

}  // namespace

std::string subject_text(const Body& body) {
  TomlWriter out;
  out.comment("A subject. Metres, radians; frames parallel to the world's (Y up) in a");
  out.comment("T-pose that faces +Z. Quaternions w, x, y, z. sigma: standard deviation.");
  out.integer("format", 1);
  out.text("name", body.name);
  out.number("stature_m", body.stature_m);
  if (body.mass_kg) out.number("mass_kg", *body.mass_kg);
  out.table({"tips"});
  for (const Tip& tip : kTips) {
    write_vector(out, tip.key, body.proportions.*tip.p_in_bone);
  }
  for (const HumanBone bone : human_bones()) write_joint(out, body, bone);
  write_hinges(out, body);
  for (const PlacedTag& placed : body.tags) write_tag(out, placed);
  for (const PlacedMarker& placed : body.markers) write_marker(out, placed);
  for (const Finding& warning : body.warnings) write_warning(out, warning);
  return out.str();
}

Status write_subject(const std::filesystem::path& path, const Body& body) {
  return write_file(path, subject_text(body));
}

Result<Body> parse_subject(std::string_view text, const std::string& file) {
  Result<TomlDocument> document = parse_toml(text, file, "subject.md");
  if (!document) return document.error();
  TomlReader root(*document);
  root.allow({"format",
              "name",
              "stature_m",
              "mass_kg",
              "tips",
              "joint",
              "hinge",
              "tag",
              "marker",
              "doubt"});
  (void)root.integer("format", {1, 1});
  Body body;
  body.name = root.text("name");
  body.stature_m = root.number("stature_m", kLength);
  if (root.has("mass_kg")) body.mass_kg = root.number("mass_kg", kSubjectMass);
  TomlReader tips = root.table("tips");
  std::vector<std::string_view> tip_keys;
  tip_keys.reserve(kTips.size());
  for (const Tip& tip : kTips) tip_keys.push_back(tip.key);
  tips.allow(tip_keys);
  for (const Tip& tip : kTips) {
    body.proportions.*tip.p_in_bone = read_vector(tips, tip.key);
  }
  read_joints(root, body);
  read_hinges(root, body);
  for (TomlReader& tag : root.tables("tag")) read_tag(tag, body);
  for (TomlReader& marker : root.tables("marker")) read_marker(marker, body);
  for (TomlReader& warning : root.tables("doubt")) read_warning(warning, body);
  if (document->mistake) return mistake_of(*document, TomlKind::kSubject);
  return body;
}

Result<Body> read_subject(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_subject(*text, path.string());
}

}  // namespace marey::recordings
