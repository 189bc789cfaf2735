// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/body_judge.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <complex>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/lower_case.h"
#include "tests/support/files/acclaim.h"
#include "tests/support/files/plain_bvh.h"
#include "tests/support/files/text_file.h"
#include "tests/support/truth/foot_judge.h"

namespace marey::testing {
namespace {

using B = HumanBone;

constexpr std::array kBones{B::kHips,
                            B::kNeck,
                            B::kHead,
                            B::kLeftUpperArm,
                            B::kLeftLowerArm,
                            B::kLeftHand,
                            B::kLeftUpperLeg,
                            B::kLeftLowerLeg,
                            B::kLeftFoot,
                            B::kLeftToes,
                            B::kRightUpperArm,
                            B::kRightLowerArm,
                            B::kRightHand,
                            B::kRightUpperLeg,
                            B::kRightLowerLeg,
                            B::kRightFoot,
                            B::kRightToes};

// Names without "mixamorig:", blanks and marks, in small letters; left ones only, "@" is
// where the side stands.
const std::map<B, std::vector<std::string>>& aliases() {
  static const std::map<B, std::vector<std::string>> kNames{
      {B::kHips, {"hips", "pelvis", "defspine", "ccbasehip", "root"}},
      {B::kNeck, {"neck", "neck01", "defspine004", "lowerneck", "ccbasenecktwist01"}},
      {B::kHead, {"head", "defspine006", "ccbasehead"}},
      {B::kLeftUpperArm,
       {"@arm", "upperarm@", "@upperarm", "defupperarm@", "ccbase@upperarm", "@humerus"}},
      {B::kLeftLowerArm,
       {"@forearm",
        "lowerarm@",
        "@lowerarm",
        "forearm@",
        "defforearm@",
        "ccbase@forearm",
        "@elbow",
        "@radius"}},
      {B::kLeftHand,
       {"@hand", "hand@", "defhand@", "palm@", "ccbase@hand", "wrist@", "@wrist"}},
      {B::kLeftUpperLeg,
       {"@upleg",
        "thigh@",
        "@upperleg",
        "upperleg@",
        "defthigh@",
        "ccbase@thigh",
        "@femur"}},
      {B::kLeftLowerLeg,
       {"@leg",
        "calf@",
        "@lowerleg",
        "lowerleg@",
        "shin@",
        "defshin@",
        "ccbase@calf",
        "@knee",
        "@tibia"}},
      {B::kLeftFoot, {"@foot", "foot@", "deffoot@", "ccbase@foot", "@ankle"}},
      {B::kLeftToes,
       {"@toebase",
        "ball@",
        "@toes",
        "toes@",
        "toe@",
        "ccbase@toebase",
        "deftoe@",
        "foot@end",
        "@toe"}}};
  return kNames;
}

std::string plain(const std::string& node) {
  const std::size_t colon = node.find(':');
  std::string out;
  for (const char c : colon == std::string::npos ? node : node.substr(colon + 1)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      out += lower_case(c);
    }
  }
  return out;
}

std::string with_side(const std::string& alias, const std::string& side) {
  const std::size_t at = alias.find('@');
  return at == std::string::npos ? alias
                                 : alias.substr(0, at) + side + alias.substr(at + 1);
}

std::optional<std::string> find_node(const std::vector<std::string>& names, B bone) {
  const bool left = std::string_view(name(bone)).starts_with("left");
  const bool right = std::string_view(name(bone)).starts_with("right");
  const auto found = aliases().find(right ? mirrored(bone) : bone);
  if (found == aliases().end()) return std::nullopt;
  // A rig of "Left knee" and "Left leg" means the thigh by the latter.
  const bool has_knees = std::ranges::any_of(names, [](const std::string& n) {
    return plain(n).find("knee") != std::string::npos &&
           plain(n).find("pole") == std::string::npos;
  });
  for (const std::string& alias : found->second) {
    for (const char* side : {left ? "left" : "right", left ? "l" : "r"}) {
      std::string wanted = left || right ? with_side(alias, side) : alias;
      if (has_knees && alias == "@leg") continue;
      if (has_knees && alias == "@upleg") wanted = with_side("@leg", side);
      for (const std::string& node : names) {
        if (plain(node) == wanted) return node;
      }
    }
  }
  return std::nullopt;
}

std::vector<Landmarks> of_bvh(const std::filesystem::path& path) {
  const PlainBvh bvh(path);
  const auto nodes = bone_nodes(bvh.names());
  std::vector<Landmarks> out;
  for (std::size_t t = 0; t < bvh.frame_count(); ++t) {
    const auto places = bvh.places(t);
    Landmarks marks;
    for (const auto& [bone, node] : nodes) {
      const auto at = std::ranges::find(bvh.names(), node) - bvh.names().begin();
      marks[bone] = 0.01 * places[static_cast<std::size_t>(at)];
    }
    out.push_back(std::move(marks));
  }
  return out;
}

std::vector<Landmarks> of_amc(const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  const auto asf = path.parent_path() / (stem.substr(0, stem.find('_')) + ".asf");
  const auto skeleton = parse_asf(read_text(asf), asf.string());
  if (!skeleton) throw std::runtime_error(skeleton.error().message());
  const auto frames = parse_amc(*skeleton, read_text(path), path.string());
  if (!frames) throw std::runtime_error(frames.error().message());
  std::vector<std::string> names;
  for (const AcclaimBone& bone : skeleton->bones) names.push_back(bone.name);
  auto nodes = bone_nodes(names);
  nodes[B::kNeck] = "lowerneck";
  std::vector<Landmarks> out;
  for (const auto& frame : *frames) {
    const auto bones = file_from_bones(*skeleton, frame);
    Landmarks marks;
    for (const auto& [bone, node] : nodes) {
      marks[bone] = bones[*skeleton->find(node)].translation;
    }
    out.push_back(std::move(marks));
  }
  return out;
}

Landmarks landmarks_of(const PosedGlb& body, const std::map<B, std::string>& nodes) {
  Landmarks marks;
  for (const auto& [bone, node] : nodes) {
    if (const auto at = body.node(node)) marks[bone] = body.place(*at);
  }
  return marks;
}

std::vector<Landmarks> of_glb(const std::filesystem::path& path) {
  PosedGlb glb(path);
  const auto nodes = bone_nodes(glb.node_names());
  std::vector<Landmarks> out;
  for (const double time_s : glb.times()) {
    glb.pose(time_s);
    out.push_back(landmarks_of(glb, nodes));
  }
  return out;
}

glm::dvec3 middle(const Landmarks& marks, B left) {
  return 0.5 * (marks.at(left) + marks.at(mirrored(left)));
}

/// Directions that bodies are compared by; nullopt where a landmark is missing.
std::map<std::string, glm::dvec3> directions(const Landmarks& marks) {
  std::map<std::string, glm::dvec3> out;
  const auto add = [&](B from, B to) {
    if (!marks.contains(from) || !marks.contains(to)) return;
    const glm::dvec3 way = marks.at(to) - marks.at(from);
    if (glm::length(way) > 1e-6) out[std::string(name(from))] = glm::normalize(way);
  };
  for (const auto& [from, to] : {std::pair{B::kLeftUpperArm, B::kLeftLowerArm},
                                 std::pair{B::kLeftLowerArm, B::kLeftHand},
                                 std::pair{B::kLeftUpperLeg, B::kLeftLowerLeg},
                                 std::pair{B::kLeftLowerLeg, B::kLeftFoot}}) {
    add(from, to);
    add(mirrored(from), mirrored(to));
  }
  if (marks.contains(B::kLeftUpperArm) && marks.contains(B::kRightUpperArm)) {
    out["trunk"] =
        glm::normalize(middle(marks, B::kLeftUpperArm) - middle(marks, B::kLeftUpperLeg));
  }
  add(B::kNeck, B::kHead);
  return out;
}

glm::dvec3 across(const Landmarks& marks) {
  return marks.at(B::kLeftUpperLeg) - marks.at(B::kRightUpperLeg);
}

/// Returns true when the feet's mean direction opposes the front of hips and trunk;
/// nullopt without toe joints.
std::optional<bool> feet_backwards(const Landmarks& marks) {
  if (!marks.contains(B::kLeftToes) || !marks.contains(B::kRightToes))
    return std::nullopt;
  const glm::dvec3 up = middle(marks, B::kLeftUpperArm) - middle(marks, B::kLeftUpperLeg);
  const glm::dvec3 front = glm::cross(across(marks), up);
  const glm::dvec3 feet = middle(marks, B::kLeftToes) - middle(marks, B::kLeftFoot);
  return glm::dot(front, feet) < 0.0;
}

double height_of(const Landmarks& marks) {
  double sum =
      glm::distance(middle(marks, B::kLeftUpperLeg), middle(marks, B::kLeftUpperArm));
  sum += glm::distance(marks.at(B::kLeftUpperLeg), marks.at(B::kLeftLowerLeg));
  sum += glm::distance(marks.at(B::kLeftLowerLeg), marks.at(B::kLeftFoot));
  return 1.15 * sum;
}

double fastest(const std::vector<Landmarks>& frames, double hz) {
  double maximum = 0.0;
  for (std::size_t t = 1; t < frames.size(); ++t) {
    for (const auto& [bone, place] : frames[t]) {
      maximum = std::max(maximum, glm::distance(place, frames[t - 1].at(bone)) * hz);
    }
  }
  return maximum / height_of(frames.front());
}

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// The turn about Y that brings the source's headings to the body's, on average. [rad]
double heading_between(const std::vector<Landmarks>& source,
                       const std::vector<Landmarks>& body) {
  std::complex<double> sum = 0.0;
  for (std::size_t t = 0; t < source.size(); ++t) {
    const glm::dvec3 a = across(source[t]);
    const glm::dvec3 b = across(body[t]);
    sum += std::complex<double>(b.z, b.x) * std::conj(std::complex<double>(a.z, a.x)) /
           (glm::length(a) * glm::length(b));
  }
  return std::arg(sum);
}

void compare(const std::vector<Landmarks>& source,
             const std::vector<Landmarks>& body,
             BodyFigures& out) {
  const double heading_rad = heading_between(source, body);
  out.heading_deg = glm::degrees(heading_rad);
  const glm::dquat turn = glm::angleAxis(heading_rad, glm::dvec3(0, 1, 0));
  std::map<std::string, std::vector<double>> apart_deg;
  double exchanged = 0.0;
  for (std::size_t t = 0; t < source.size(); ++t) {
    const auto a = directions(source[t]);
    for (const auto& [segment, way] : directions(body[t])) {
      const auto wanted = a.find(segment);
      if (wanted == a.end()) continue;
      const double cosine = std::clamp(glm::dot(turn * wanted->second, way), -1.0, 1.0);
      apart_deg[segment].push_back(glm::degrees(std::acos(cosine)));
    }
    const auto of_source = feet_backwards(source[t]);
    const auto of_body = feet_backwards(body[t]);
    if (of_source && of_body && *of_source != *of_body) exchanged += 1.0;
  }
  out.exchanged_share = exchanged / static_cast<double>(source.size());
  for (const auto& [segment, values] : apart_deg) {
    const double median = quantile_of(values, 0.5);
    out.medians_deg[segment] = median;
    if (segment == "neck") continue;
    if (segment == "trunk") out.trunk_median_deg = median;
    if (segment.find("Arm") != std::string::npos) {
      out.arms_median_deg = std::max(out.arms_median_deg, median);
      continue;
    }
    out.worst_p95_deg = std::max(out.worst_p95_deg, quantile_of(values, 0.95));
    if (median <= out.worst_median_deg) continue;
    out.worst_median_deg = median;
    out.worst_segment = segment;
  }
}

}  // namespace

std::map<B, std::string> bone_nodes(const std::vector<std::string>& names) {
  std::map<B, std::string> out;
  for (const B bone : kBones) {
    if (const auto node = find_node(names, bone)) out[bone] = *node;
  }
  return out;
}

std::vector<Landmarks> read_landmarks(const std::filesystem::path& path) {
  const std::string kind = path.extension().string();
  std::vector<Landmarks> out = kind == ".bvh"   ? of_bvh(path)
                               : kind == ".amc" ? of_amc(path)
                                                : of_glb(path);
  if (out.empty() || !out.front().contains(B::kLeftUpperLeg) ||
      !out.front().contains(B::kRightFoot)) {
    throw std::runtime_error(path.string() + ": unknown names");
  }
  return out;
}

BodyFigures judge_body(PosedGlb& body,
                       const std::map<B, std::string>& nodes,
                       const std::vector<Landmarks>& source) {
  BodyFigures out;
  out.frames = body.times().size();
  if (out.frames != source.size()) {
    throw std::runtime_error(std::to_string(out.frames) + " frames of " +
                             std::to_string(source.size()));
  }
  std::vector<Landmarks> frames;
  std::vector<double> ankles;
  for (std::size_t t = 0; t < out.frames; ++t) {
    body.pose(body.times()[t]);
    frames.push_back(landmarks_of(body, nodes));
    const PosedGlb::Lowest lowest = body.lowest();
    if (-1e3 * lowest.y_m > out.skin_depth_mm) {
      out.skin_depth_mm = -1e3 * lowest.y_m;
      out.skin_frame = static_cast<int>(t);
      out.skin_node = lowest.node;
    }
    ankles.push_back(
        std::min(source[t].at(B::kLeftFoot).y, source[t].at(B::kRightFoot).y));
  }
  // The ankle joint of a standing foot is at least 3 cm above the floor.
  const double floor_m = quantile_of(ankles, 0.05) - 0.03;
  for (const Landmarks& marks : source) {
    for (const auto& [bone, place] : marks) {
      const bool is_left_foot = bone == B::kLeftFoot || bone == B::kLeftToes;
      if (is_left_foot || bone == B::kRightFoot || bone == B::kRightToes) continue;
      out.source_depth_mm = std::max(out.source_depth_mm, 1e3 * (floor_m - place.y));
    }
  }
  const double hz = out.frames > 1 ? 1.0 / (body.times()[1] - body.times()[0]) : 1.0;
  out.max_speed = fastest(frames, hz);
  out.source_max_speed = fastest(source, hz);
  compare(source, frames, out);
  compare_feet(source, frames, hz, out);
  return out;
}

}  // namespace marey::testing
