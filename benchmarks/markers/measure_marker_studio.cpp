// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "benchmarks/markers/marker_subject.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "tests/support/files/acclaim.h"

namespace marey {
namespace {

using testing::AcclaimSkeleton;
using B = HumanBone;

/// The studio's solution: every bone of every frame, in its file's frame.
struct Studio {
  AcclaimSkeleton skeleton;
  std::vector<std::vector<RigidTransform>> file_from_bones;
};

Studio read_studio(const std::filesystem::path& folder) {
  const auto text = [&](const char* file) {
    auto read = recordings::read_file(folder / file);
    if (!read) stop(read.error().message());
    return *std::move(read);
  };
  const auto skeleton = testing::parse_asf(text("02.asf"), "02.asf");
  if (!skeleton) stop(skeleton.error().message());
  const auto frames = testing::parse_amc(*skeleton, text("02_05.amc"), "02_05.amc");
  if (!frames) stop(frames.error().message());
  Studio studio{*skeleton, {}};
  for (const auto& frame : *frames) {
    studio.file_from_bones.push_back(testing::file_from_bones(*skeleton, frame));
  }
  return studio;
}

/// A candidate alignment of the studio's file with the tracks' world.
struct Alignment {
  glm::dmat3 world_from_file{1.0};
  int later = 0;            ///< The studio's frame f is the tracks' f + later.
  double stray_m = 1e9;     ///< RMS per marker in its bone; median of the markers.
  glm::dvec3 shift_m{0.0};  ///< Shift of the file with the least RMS.
};

/// Mean position q of a marker in a bone, and its variance: p = shift + start + turn * q.
struct Keeping {
  glm::dmat3 mean_turn{0.0};     ///< From file to bone.
  glm::dvec3 mean_in_bone{0.0};  ///< Mean of p - start.
  double variance_m2 = 1e9;
  int frames = 0;
};

/// Calls `use(p - start, from file to bone)` for every tenth frame.
template <class Use>
void each_frame(const Studio& studio,
                const MarkerTracks& tracks,
                std::size_t marker,
                std::size_t bone,
                const Alignment& a,
                Use&& use) {
  const glm::dmat3 file_from_world = glm::transpose(a.world_from_file);
  for (std::size_t f = 10; f + 10 < studio.file_from_bones.size(); f += 10) {
    const auto at = static_cast<std::size_t>(static_cast<int>(f) + a.later);
    if (at >= tracks.frames() || !tracks.at(at, marker)) continue;
    const RigidTransform& b = studio.file_from_bones[f][bone];
    use(file_from_world * tracks.at(at, marker)->p_in_world - b.translation,
        glm::transpose(glm::mat3_cast(b.rotation)));
  }
}

Keeping keeping(const Studio& studio,
                const MarkerTracks& tracks,
                std::size_t marker,
                std::size_t bone,
                const Alignment& a) {
  Keeping out;
  double squares = 0.0;
  each_frame(studio, tracks, marker, bone, a, [&](const auto& p, const auto& turn) {
    out.mean_turn += turn;
    out.mean_in_bone += turn * p;
    squares += glm::dot(p, p);
    ++out.frames;
  });
  if (out.frames < 30) return out;
  out.mean_turn /= out.frames;
  out.mean_in_bone /= out.frames;
  out.variance_m2 = squares / out.frames - glm::dot(out.mean_in_bone, out.mean_in_bone);
  return out;
}

/// Assigns every marker to the bone with the least variance. Computes the RMS deviation
/// of the markers, and the shift of the whole file that minimizes it (linear least
/// squares).
void assign_bones(const Studio& studio, const MarkerTracks& tracks, Alignment& a) {
  Distances strays;
  glm::dmat3 normal(0.0);
  glm::dvec3 right(0.0);
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    Keeping best;
    std::size_t its_bone = 0;
    for (std::size_t bone = 0; bone < studio.skeleton.bones.size(); ++bone) {
      const Keeping one = keeping(studio, tracks, m, bone, a);
      if (one.variance_m2 >= best.variance_m2) continue;
      best = one;
      its_bone = bone;
    }
    if (best.frames == 0) continue;
    strays.add(std::sqrt(std::max(best.variance_m2, 0.0)));
    each_frame(studio, tracks, m, its_bone, a, [&](const auto& p, const auto& turn) {
      const glm::dmat3 file_from_bone = glm::transpose(turn);
      const glm::dmat3 row = glm::dmat3(1.0) - file_from_bone * best.mean_turn;
      normal += glm::transpose(row) * row;
      right += glm::transpose(row) * (p - file_from_bone * best.mean_in_bone);
    });
  }
  a.stray_m = 1e-3 * strays.quantile_mm(0.5);
  a.shift_m = a.world_from_file * (glm::inverse(normal) * right);
}

/// Returns the rotations of a cube: the axes of one file in another's.
std::vector<glm::dmat3> axis_maps() {
  std::vector<glm::dmat3> out;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (y == x) continue;
      for (const double sx : {1.0, -1.0}) {
        for (const double sy : {1.0, -1.0}) {
          glm::dmat3 map(0.0);
          map[0][x] = sx;
          map[1][y] = sy;
          map[2] = glm::cross(map[0], map[1]);
          out.push_back(map);
        }
      }
    }
  }
  return out;
}

/// Returns the alignment with the least deviation of the markers from the studio's bones.
Alignment align_files(const Studio& studio, const MarkerTracks& tracks) {
  Alignment best;
  const auto try_one = [&](const glm::dmat3& map, int later) {
    Alignment one{map, later};
    assign_bones(studio, tracks, one);
    if (one.stray_m < best.stray_m) best = one;
  };
  for (const glm::dmat3& map : axis_maps()) try_one(map, 0);
  const glm::dmat3 map = best.world_from_file;
  for (int later = -4; later <= 4; ++later) try_one(map, later);
  return best;
}

struct Compared {
  B joint;
  const char* bone;  ///< Bone of the studio that starts at the joint.
};

constexpr std::array kCompared{
    Compared{B::kLeftUpperLeg, "lfemur"},
    Compared{B::kRightUpperLeg, "rfemur"},
    Compared{B::kLeftLowerLeg, "ltibia"},
    Compared{B::kRightLowerLeg, "rtibia"},
    Compared{B::kLeftFoot, "lfoot"},
    Compared{B::kRightFoot, "rfoot"},
    Compared{B::kLeftUpperArm, "lhumerus"},
    Compared{B::kRightUpperArm, "rhumerus"},
    Compared{B::kLeftLowerArm, "lradius"},
    Compared{B::kRightLowerArm, "rradius"},
    Compared{B::kLeftHand, "lwrist"},
    Compared{B::kRightHand, "rwrist"},
};
// Joints that are printed but not pooled: other body models place them elsewhere.
constexpr std::array kReported{
    Compared{B::kLeftHand, "lhand"},
    Compared{B::kRightHand, "rhand"},
    Compared{B::kLeftToes, "ltoes"},
    Compared{B::kRightToes, "rtoes"},
    Compared{B::kNeck, "lowerneck"},
    Compared{B::kHead, "head"},
    Compared{B::kHips, "root"},
    Compared{B::kLeftShoulder, "lclavicle"},
    Compared{B::kRightShoulder, "rclavicle"},
};

struct Differences {
  Distances distances;
  glm::dvec3 mean_in_parent{0.0};  ///< Ours less theirs, in our parent bone's axes. [m]
  glm::dvec3 spread_in_parent{0.0};
};

Differences compare(const Compared& one,
                    const Motion& mine,
                    const Studio& studio,
                    const Alignment& alignment) {
  Differences out;
  const std::size_t bone = *studio.skeleton.find(one.bone);
  const std::size_t joint = index(one.joint);
  const std::size_t above = index(parent(one.joint).value_or(B::kHips));
  glm::dvec3 squares(0.0);
  for (std::size_t f = 0; f < studio.file_from_bones.size(); ++f) {
    const auto at = static_cast<std::size_t>(static_cast<int>(f) + alignment.later);
    if (at >= mine.poses.size()) continue;
    const auto joints = world_from_joints(mine.skeleton, mine.poses[at]);
    const glm::dvec3 theirs =
        alignment.world_from_file * studio.file_from_bones[f][bone].translation;
    const glm::dvec3 off = joints[joint].translation - theirs;
    out.distances.add(glm::length(off));
    const glm::dvec3 in_parent = glm::conjugate(joints[above].rotation) * off;
    out.mean_in_parent += in_parent;
    squares += in_parent * in_parent;
  }
  const auto count = static_cast<double>(out.distances.size());
  out.mean_in_parent /= count;
  out.spread_in_parent =
      glm::sqrt(squares / count - out.mean_in_parent * out.mean_in_parent);
  return out;
}

void print(const Compared& one, const Differences& d) {
  std::printf("%-14s %-10s %6.1f %6.1f   %+6.1f %+6.1f %+6.1f   %5.1f %5.1f %5.1f\n",
              std::string(name(one.joint)).c_str(),
              one.bone,
              d.distances.quantile_mm(0.5),
              d.distances.quantile_mm(0.95),
              1e3 * d.mean_in_parent.x,
              1e3 * d.mean_in_parent.y,
              1e3 * d.mean_in_parent.z,
              1e3 * d.spread_in_parent.x,
              1e3 * d.spread_in_parent.y,
              1e3 * d.spread_in_parent.z);
}

void compare_lengths(const Studio& studio, const Body& body) {
  struct Length {
    const char* name;
    B far;
    const char* from;
    const char* to;
  };
  constexpr std::array kLengths{
      Length{"left thigh", B::kLeftLowerLeg, "lfemur", "ltibia"},
      Length{"right thigh", B::kRightLowerLeg, "rfemur", "rtibia"},
      Length{"left shank", B::kLeftFoot, "ltibia", "lfoot"},
      Length{"right shank", B::kRightFoot, "rtibia", "rfoot"},
      Length{"left upper arm", B::kLeftLowerArm, "lhumerus", "lradius"},
      Length{"right upper arm", B::kRightLowerArm, "rhumerus", "rradius"},
      Length{"left forearm", B::kLeftHand, "lradius", "lwrist"},
      Length{"right forearm", B::kRightHand, "rradius", "rwrist"},
      Length{"left forearm", B::kLeftHand, "lradius", "lhand"},
      Length{"right forearm", B::kRightHand, "rradius", "rhand"},
  };
  const auto& rest = studio.file_from_bones.front();
  const auto theirs_m = [&](const char* from, const char* to) {
    return glm::distance(rest[*studio.skeleton.find(from)].translation,
                         rest[*studio.skeleton.find(to)].translation);
  };
  std::printf("lengths, mm: ours, theirs, difference\n");
  const auto line = [](const char* name, double mine_m, double their_m) {
    std::printf("%-16s %6.1f %6.1f %+6.1f\n",
                name,
                1e3 * mine_m,
                1e3 * their_m,
                1e3 * (mine_m - their_m));
  };
  for (const Length& l : kLengths) {
    line(l.name, glm::length(body.proportions[l.far]), theirs_m(l.from, l.to));
  }
  line("between hips",
       glm::distance(body.proportions[B::kLeftUpperLeg],
                     body.proportions[B::kRightUpperLeg]),
       theirs_m("lfemur", "rfemur"));
}

}  // namespace

int measure_studio(const std::filesystem::path& mocap) {
  const std::vector<std::filesystem::path> files{mocap /
                                                 "nimblephysics/c3d/cmu_02_05.c3d"};
  const MarkerPerson person = read_person(files);
  const auto solved = solve(person.fit.body, person.trials[0]);
  const Studio studio = read_studio(mocap / "cmu_asfamc");
  const Alignment alignment = align_files(studio, person.trials[0]);
  const glm::dmat3& map = alignment.world_from_file;
  std::printf("frames: %zu of the tracks, %zu of the studio's, which are %d later\n",
              person.trials[0].frames(),
              studio.file_from_bones.size(),
              alignment.later);
  std::printf(
      "the file's X, Y, Z in the world: %.0f %.0f %.0f, %.0f %.0f %.0f, "
      "%.0f %.0f %.0f; markers stray %.1f mm from its bones (median) and would have it "
      "shifted by %.1f %.1f %.1f mm\n",
      map[0].x,
      map[0].y,
      map[0].z,
      map[1].x,
      map[1].y,
      map[1].z,
      map[2].x,
      map[2].y,
      map[2].z,
      1e3 * alignment.stray_m,
      1e3 * alignment.shift_m.x,
      1e3 * alignment.shift_m.y,
      1e3 * alignment.shift_m.z);
  std::printf("our markers' rms %.1f mm\n", 1e3 * solved.rms_m);
  std::printf("%-14s %-10s %6s %6s   %s\n",
              "joint",
              "theirs",
              "median",
              "p95",
              "ours less theirs in our parent's axes: mean; spread [mm]");
  Distances pooled;
  Distances but_hands;
  for (const Compared& one : kCompared) {
    const auto d = compare(one, solved.estimate.motion, studio, alignment);
    print(one, d);
    pooled.add(d.distances);
    if (one.joint != B::kLeftHand && one.joint != B::kRightHand) {
      but_hands.add(d.distances);
    }
  }
  // The studio's forearm has two bones. The source does not specify which of them ends at
  // the wrist.
  const auto sum = [](const char* what, const Distances& d) {
    std::printf("%-25s %6.1f %6.1f\n", what, d.quantile_mm(0.5), d.quantile_mm(0.95));
  };
  sum("pooled", pooled);
  sum("pooled without hands", but_hands);
  for (const Compared& one : kReported) {
    print(one, compare(one, solved.estimate.motion, studio, alignment));
  }
  compare_lengths(studio, person.fit.body);
  return 0;
}

}  // namespace marey
