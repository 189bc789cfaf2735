// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bodies/made_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include "tests/support/bodies/random_bodies.h"
#include "tests/support/files/made_glb.h"

namespace marey::testing {
namespace {

using B = HumanBone;

struct Bone {
  std::string name;
  int parent = -1;
  glm::dvec3 place{0.0};  // World, at rest, facing +Z.
  bool carries_skin = true;
};

// Builds places at rest, then the skin about them.
class Maker {
 public:
  explicit Maker(const MadeBodyRule& rule) : rule_(rule) {
    lay_trunk();
    for (const double x : {1.0, -1.0}) {
      lay_leg(x);
      lay_arm(x);
    }
    if (rule.hair) lay_chain("hair_", {0, -0.04, -0.0175});
    if (rule.ears) lay_chain("ear_", {0, 0.1, 0});
    skin_trunk();
    for (const double x : {1.0, -1.0}) {
      skin_leg(x);
      skin_arm(x);
    }
  }

  const MadeBodyRule& rule_;
  std::vector<Bone> bones_;
  std::map<B, int> of_;
  std::vector<MadeVertices> meshes_{2};

 private:
  int add(std::string bone_name, int parent, const glm::dvec3& place, bool skin = true) {
    bones_.push_back({std::move(bone_name), parent, place, skin});
    return static_cast<int>(bones_.size()) - 1;
  }
  int add(B bone, int parent, const glm::dvec3& place) {
    const int at = add(made_bone_name(rule_.naming, bone), parent, place);
    of_[bone] = at;
    return at;
  }
  static B on(B left, double x) { return x > 0.0 ? left : mirrored(left); }
  [[nodiscard]] glm::dvec3 at(B bone) const {
    return bones_[static_cast<std::size_t>(of_.at(bone))].place;
  }
  [[nodiscard]] int id(B bone) const { return of_.at(bone); }

  void lay_trunk() {
    const double s = rule_.stature_m;
    const double thigh = 0.245 * s * rule_.legs;
    const double shank = 0.246 * s * rule_.legs;
    const double knee = glm::radians(rule_.knees_deg);
    hip_y_ = 0.039 * s + (thigh + shank) * std::cos(0.5 * knee);
    const double trunk = 0.29 * s * rule_.trunk;
    const double hips_y = hip_y_ + 0.02 * s;
    int root = -1;
    if (rule_.root_at_floor) {
      root = add("root", -1, {0, 0, 0}, false);
      if (rule_.ik_bones) {
        for (const char* side : {".L", ".R"}) {
          const double x = side[1] == 'L' ? 1.0 : -1.0;
          add(std::string("IK_foot") + side, root, {0.055 * s * x, 0.039 * s, 0}, false);
          add(std::string("pole_knee") + side,
              root,
              {0.055 * s * x, 0.3 * s, 0.4 * s},
              false);
        }
      }
    }
    int at = add(B::kHips, root, {0, hips_y, 0});
    for (int i = 0; i < rule_.spine_bones; ++i) {
      const double up = (i + 0.5) / rule_.spine_bones;
      at = add(made_spine_name(rule_.naming, i),
               at,
               {0, hips_y + trunk * 0.9 * up, -0.01 * s});
    }
    chest_ = at;
    shoulder_y_ = hips_y + 0.92 * trunk;
    const int neck = add(B::kNeck, chest_, {0, hips_y + trunk, 0});
    add(B::kHead, neck, {0, hips_y + trunk + 0.05 * s, 0.01 * s});
  }

  void lay_leg(double x) {
    const double s = rule_.stature_m;
    const double half = 0.5 * glm::radians(rule_.knees_deg);
    const glm::dvec3 hip(0.055 * s * x, hip_y_, 0);
    const glm::dvec3 knee =
        hip + 0.245 * s * rule_.legs * glm::dvec3(0, -std::cos(half), std::sin(half));
    const glm::dvec3 ankle =
        knee + 0.246 * s * rule_.legs * glm::dvec3(0, -std::cos(half), -std::sin(half));
    const int upper = add(on(B::kLeftUpperLeg, x), id(B::kHips), hip);
    twist(upper, knee, "thigh_twist", x);
    const int lower = add(on(B::kLeftLowerLeg, x), upper, knee);
    const int foot = add(on(B::kLeftFoot, x), lower, ankle);
    add(on(B::kLeftToes, x), foot, ankle + glm::dvec3(0, -0.029 * s, 0.1 * s));
  }

  void lay_arm(double x) {
    const double s = rule_.stature_m;
    const double down = glm::radians(rule_.arms_down_deg);
    const glm::dvec3 along(x * std::cos(down), -std::sin(down), 0);
    const glm::dvec3 collar(0.02 * s * x, shoulder_y_, 0);
    const glm::dvec3 shoulder(0.11 * s * x, shoulder_y_, 0);
    const glm::dvec3 elbow = shoulder + 0.172 * s * rule_.arms * along;
    const glm::dvec3 wrist = elbow + 0.157 * s * rule_.arms * along;
    const int clavicle = add(on(B::kLeftShoulder, x), chest_, collar);
    const int upper = add(on(B::kLeftUpperArm, x), clavicle, shoulder);
    twist(upper, elbow, "upperarm_twist", x);
    const int lower = add(on(B::kLeftLowerArm, x), upper, elbow);
    twist(lower, wrist, "lowerarm_twist", x);
    const int hand = add(on(B::kLeftHand, x), lower, wrist);
    if (!rule_.fingers) return;
    for (const char* finger : {"index", "middle", "ring"}) {
      int at = hand;
      for (int k = 1; k <= 3; ++k) {
        at = add(std::string(finger) + "_0" + std::to_string(k) + (x > 0 ? "_l" : "_r"),
                 at,
                 wrist + (0.03 + 0.015 * k) * s * along);
      }
    }
  }

  void twist(int upper, const glm::dvec3& end, const char* bone_name, double x) {
    if (!rule_.twist_bones) return;
    const glm::dvec3 start = bones_[static_cast<std::size_t>(upper)].place;
    add(std::string(bone_name) + (x > 0 ? "_l" : "_r"), upper, 0.5 * (start + end));
  }

  // Four bones that hang on the head, each so far from the one before, in statures.
  void lay_chain(const std::string& bone_name, const glm::dvec3& step) {
    int at = id(B::kHead);
    const glm::dvec3 start =
        this->at(B::kHead) + rule_.stature_m * glm::dvec3(0, 0.08, -0.05);
    for (int k = 0; k < 4; ++k) {
      at = add(bone_name + std::to_string(k), at, start + rule_.stature_m * k * step);
      chains_.push_back({at, k > 0});
    }
  }

  // A tube from `from` to `to`, carried by `bone`, by `above` near its start and `below`
  // near its end.
  void tube(int mesh,
            const glm::dvec3& from,
            const glm::dvec3& to,
            double radius_m,
            int above,
            int bone,
            int below) {
    constexpr int kRings = 9;
    constexpr int kSides = 10;
    const glm::dvec3 along = glm::normalize(to - from);
    const glm::dvec3 helper =
        std::abs(along.y) > 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(helper, along));
    const glm::dvec3 y = glm::cross(along, x);
    MadeVertices& out = meshes_[static_cast<std::size_t>(rule_.two_skins ? mesh : 0)];
    const auto first = static_cast<unsigned>(out.places.size());
    for (int ring = 0; ring < kRings; ++ring) {
      const double share = ring / (kRings - 1.0);
      for (int k = 0; k < kSides; ++k) {
        const double turn = 2.0 * 3.14159265358979 * k / kSides;
        out.places.push_back(glm::mix(from, to, share) +
                             radius_m * (std::cos(turn) * x + std::sin(turn) * y));
        const double near = std::clamp(0.5 - 3.0 * share, 0.0, 0.5);
        const double far = std::clamp(0.5 - 3.0 * (1.0 - share), 0.0, 0.5);
        out.carriers.push_back({{{above, near}, {bone, 1.0 - near - far}, {below, far}}});
      }
    }
    for (unsigned ring = 0; ring + 1 < kRings; ++ring) {
      for (unsigned k = 0; k < kSides; ++k) {
        const unsigned a = first + ring * kSides + k;
        const unsigned b = first + ring * kSides + (k + 1) % kSides;
        for (const unsigned v : {a, b, a + kSides, b, b + kSides, a + kSides}) {
          out.triangles.push_back(v);
        }
      }
    }
  }

  void skin_trunk() {
    const double s = rule_.stature_m;
    const double r = 0.075 * s * rule_.thick;
    const int hips = id(B::kHips);
    tube(0, {0, hip_y_ - 0.02 * s, 0}, at(B::kNeck), r, hips, hips, chest_);
    tube(0,
         {0, 0.5 * (hip_y_ + shoulder_y_), 0},
         at(B::kNeck),
         0.9 * r,
         chest_,
         chest_,
         chest_);
    const double head_r = 0.06 * s * rule_.head;
    const int head = id(B::kHead);
    const glm::dvec3 top = at(B::kHead) + glm::dvec3(0, 2.2 * head_r, 0);
    tube(0, at(B::kNeck), top, head_r, id(B::kNeck), head, head);
    for (const auto& [bone, has_before] : chains_) {
      const auto b = static_cast<std::size_t>(bone);
      if (has_before) {
        tube(0, bones_[b - 1].place, bones_[b].place, 0.02 * s, bone - 1, bone - 1, bone);
      }
    }
  }

  void skin_leg(double x) {
    const double s = rule_.stature_m;
    const int upper = id(on(B::kLeftUpperLeg, x));
    const int lower = id(on(B::kLeftLowerLeg, x));
    const int foot = id(on(B::kLeftFoot, x));
    const int toes = id(on(B::kLeftToes, x));
    const glm::dvec3 hip = at(on(B::kLeftUpperLeg, x));
    const glm::dvec3 knee = at(on(B::kLeftLowerLeg, x));
    const glm::dvec3 ankle = at(on(B::kLeftFoot, x));
    tube(0, hip, knee, 0.042 * s * rule_.thick, id(B::kHips), upper, lower);
    tube(1, knee, ankle, 0.03 * s * rule_.thick, upper, lower, foot);
    // The shoe: a box on the floor.
    MadeVertices& out = meshes_[rule_.two_skins ? 1 : 0];
    const auto first = static_cast<unsigned>(out.places.size());
    const double ball_z = ankle.z + 0.1 * s;
    const std::array<double, 6> ends{ankle.z - 0.035 * s * rule_.shoes,
                                     ankle.z,
                                     ball_z - 0.02 * s,
                                     ball_z,
                                     ball_z + 0.02 * s,
                                     ball_z + 0.04 * s * rule_.shoes};
    const std::array<double, 6> on_toes{0.0, 0.0, 0.0, 0.5, 1.0, 1.0};
    for (std::size_t k = 0; k < ends.size(); ++k) {
      for (const double side : {-0.025, 0.025}) {
        for (const double up : {0.0, 0.03}) {
          out.places.push_back({ankle.x + side * s, up * s, ends[k]});
          out.carriers.push_back(
              {{{foot, 1.0 - on_toes[k]}, {toes, on_toes[k]}, {foot, 0.0}}});
        }
      }
    }
    for (unsigned k = 0; k + 1 < ends.size(); ++k) {
      const unsigned a = first + 4 * k;
      for (const unsigned v : {a, a + 4, a + 1, a + 1, a + 4, a + 5})
        out.triangles.push_back(v);
    }
  }

  void skin_arm(double x) {
    const double s = rule_.stature_m;
    const int upper = id(on(B::kLeftUpperArm, x));
    const int lower = id(on(B::kLeftLowerArm, x));
    const int hand = id(on(B::kLeftHand, x));
    const glm::dvec3 shoulder = at(on(B::kLeftUpperArm, x));
    const glm::dvec3 elbow = at(on(B::kLeftLowerArm, x));
    const glm::dvec3 wrist = at(on(B::kLeftHand, x));
    tube(1,
         shoulder,
         elbow,
         0.026 * s * rule_.thick,
         id(on(B::kLeftShoulder, x)),
         upper,
         lower);
    tube(1, elbow, wrist, 0.02 * s * rule_.thick, upper, lower, hand);
    tube(1,
         wrist,
         wrist + 0.1 * s * glm::normalize(wrist - elbow),
         0.018 * s,
         lower,
         hand,
         hand);
  }

  std::vector<std::pair<int, bool>> chains_;  // A bone, and whether one is before it.
  double hip_y_ = 0.0;
  double shoulder_y_ = 0.0;
  int chest_ = 0;
};

}  // namespace

std::map<HumanBone, std::string> write_made_body(const MadeBodyRule& rule,
                                                 const std::filesystem::path& path) {
  const Maker maker(rule);
  MadeGlb glb;
  // Armature, scaled node, then the bones in its frame.
  glm::dmat4 file_from_marey =
      glm::mat4_cast(glm::angleAxis(glm::radians(rule.facing_deg), glm::dvec3(0, 1, 0)));
  MadeNode armature{"Armature", -1};
  if (rule.z_up)
    armature.rotation = glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0));
  armature.scale = (rule.centimetres ? 0.01 : 1.0) * rule.root_scale;
  glb.nodes.push_back(armature);
  Dice dice(rule.seed + 1);
  std::vector<glm::dmat4> world;
  const glm::dmat4 world_from_armature =
      glm::mat4_cast(armature.rotation) * glm::dmat4(glm::dmat3(armature.scale));
  for (const Bone& bone : maker.bones_) {
    const glm::dquat turn = rule.random_axes ? dice.turn(3.0) : glm::dquat(1, 0, 0, 0);
    glm::dmat4 rest = glm::mat4_cast(glm::quat_cast(glm::dmat3(file_from_marey)) * turn) *
                      glm::dmat4(glm::dmat3(armature.scale));
    rest[3] = file_from_marey * glm::dvec4(bone.place, 1.0);
    const glm::dmat4 parent = bone.parent < 0
                                  ? world_from_armature
                                  : world[static_cast<std::size_t>(bone.parent)];
    const glm::dmat4 local = glm::inverse(parent) * rest;
    MadeNode node{bone.name, bone.parent < 0 ? 0 : bone.parent + 1};
    node.translation = glm::dvec3(local[3]);
    node.rotation = glm::quat_cast(glm::dmat3(local));
    glb.nodes.push_back(node);
    glb.inverse_bind.push_back(glm::inverse(rest));
    world.push_back(rest);
  }
  for (MadeVertices mesh : maker.meshes_) {
    if (mesh.places.empty()) continue;
    for (glm::dvec3& p : mesh.places)
      p = glm::dvec3(file_from_marey * glm::dvec4(p, 1.0));
    glb.meshes.push_back(std::move(mesh));
  }
  glb.byte_weights = rule.byte_weights;
  std::map<HumanBone, std::string> names;
  for (const auto& [bone, at] : maker.of_) {
    names[bone] = maker.bones_[static_cast<std::size_t>(at)].name;
  }
  write_made_glb(glb, path);
  return names;
}

}  // namespace marey::testing
