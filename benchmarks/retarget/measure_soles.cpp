// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures visible errors of feet on real avatars, in GLB files from marey: the depth of
// the skin below the floor, and the drift of standing feet. Also measures the tilt of the
// arms in a T-pose on each body. docs/accuracy/README.md describes how to run it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "benchmarks/parts/result_table.h"
#include "benchmarks/parts/stand_as_marey.h"
#include "core/base/frame_range.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/gltf/gltf.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/motion/retarget_motion.h"

namespace marey {
namespace {

struct SkinFigures {
  double max_depth_mm = 0.0;  ///< Largest depth of the skin below the floor.
  int deep_frames = 0;        ///< Frames with a depth of more than 5 mm.
  std::string max_depth_at;   ///< Joint and frame of the largest depth.
};

SkinFigures measure_skin(const recordings::Character& file,
                         const retarget::BodyFrame& frame) {
  SkinFigures out;
  if (!file.mesh || !file.motion) return out;
  for (std::size_t t = 0; t < file.motion->poses.size(); ++t) {
    const auto places = posed_vertices(*file.mesh, file.skeleton, file.motion->poses[t]);
    double lowest_mm = 1e9;
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double y_mm = 1e3 * frame.scale * (frame.marey_from_file * places[i]).y;
      if (y_mm >= lowest_mm) continue;
      lowest_mm = y_mm;
      lowest = i;
    }
    constexpr double kDeep_mm = 5.0;
    if (lowest_mm < -kDeep_mm) ++out.deep_frames;
    if (-lowest_mm <= out.max_depth_mm) continue;
    out.max_depth_mm = -lowest_mm;
    out.max_depth_at =
        file.skeleton[file.mesh->skin[lowest].joints[0]].name + " " + std::to_string(t);
  }
  return out;
}

/// Worst horizontal drift of an ankle or a toe joint within one contact of the source's.
double worst_drift_mm(const Motion& motion,
                      const retarget::BodyMap& map,
                      const Contacts& contacts) {
  double worst_mm = 0.0;
  const auto add_slide = [&](std::optional<JointIndex> joint,
                             const std::vector<FrameRange>& runs) {
    if (!joint) return;
    for (const FrameRange& run : runs) {
      glm::dvec3 began(0.0);
      for (int t = run.first; t <= run.last; ++t) {
        const auto world =
            world_from_joints(motion.skeleton, motion.poses[static_cast<std::size_t>(t)]);
        const glm::dvec3 p = world[index(*joint)].translation;
        if (t == run.first) began = p;
        worst_mm = std::max(worst_mm,
                            1e3 * glm::length(glm::dvec2(p.x - began.x, p.z - began.z)));
      }
    }
  };
  for (int side = 0; side < 2; ++side) {
    const FootContacts& foot = contacts.feet[static_cast<std::size_t>(side)];
    const HumanBone toes = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
    add_slide(map.leg(side).end, foot.heel);
    add_slide(map.joint_of[index(toes)], foot.ball);
  }
  return worst_mm;
}

/// Computes the largest angle between an arm segment and the horizontal when the source
/// is in a T-pose. [deg]
double tilt_of_arms_deg(const Skeleton& body) {
  const Skeleton source = make_humanoid(average_proportions(1.75));
  const Motion t_pose{source, {30.0}, 0, {rest_pose(source), rest_pose(source)}};
  const auto out = retarget::retarget_motion(t_pose, body);
  if (!out) return 90.0;
  const auto world = world_from_joints(body, out->motion.poses[0]);
  double worst_rad = 0.0;
  for (std::size_t arm = 0; arm < 2; ++arm) {
    const HumanLimb& limb = human_limbs()[arm];
    for (const auto& [from, to] :
         {std::pair(limb.upper, limb.lower), std::pair(limb.lower, limb.end)}) {
      const auto a = body.find(from);
      const auto b = body.find(to);
      if (!a || !b) continue;
      const glm::dvec3 bone = world[index(*b)].translation - world[index(*a)].translation;
      worst_rad = std::max(worst_rad, std::abs(std::asin(bone.y / glm::length(bone))));
    }
  }
  return worst_rad * 180.0 / 3.14159265358979323846;
}

Status add_row(const std::filesystem::path& glb,
               const Motion& source,
               const Contacts& contacts,
               ResultTable& table) {
  const auto file = recordings::read_character(glb);
  if (!file) return file.error();
  if (!file->motion || file->motion->poses.size() != source.poses.size()) {
    return bad_input(glb.string(), "is no result of this motion", "name its own");
  }
  Motion motion = *file->motion;
  const auto frame = stand_as_marey({1.0, true}, motion);
  if (!frame) return frame.error();
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  const SkinFigures skin = measure_skin(*file, *frame);
  table.rows.push_back({glb.stem().string(),
                        frame->stature_m,
                        skin.max_depth_mm,
                        static_cast<double>(skin.deep_frames),
                        skin.max_depth_at,
                        worst_drift_mm(motion, *map, contacts),
                        tilt_of_arms_deg(motion.skeleton)});
  return Done{};
}

int run(int count, char** files) {
  const auto source = recordings::read_character(files[0]);
  if (!source || !source->motion) {
    std::fprintf(stderr, "%s: holds no motion\n", files[0]);
    return 3;
  }
  Motion motion = *source->motion;
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) {
    std::fprintf(stderr, "%s: %s\n", files[0], map.error().cause.c_str());
    return 3;
  }
  const Contacts contacts = retarget::detect_contacts(motion, *map);
  ResultTable table{"soles",
                    "Skin and feet of avatars",
                    {{"file"},
                     {"stature m", 2},
                     {"deepest skin mm", 1},
                     {"frames > 5 mm", 0},
                     {"joint, frame"},
                     {"worst drift mm", 2},
                     {"arms of a T-pose off level deg", 2}},
                    {},
                    {}};
  for (int i = 1; i < count; ++i) {
    if (const Status ok = add_row(files[i], motion, contacts, table); !ok) {
      std::fprintf(stderr, "%s: %s\n", files[i], ok.error().cause.c_str());
      return 3;
    }
  }
  print_table(table);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: measure_soles MOTION.glb RETARGETED.glb...\n");
    return 2;
  }
  return marey::run(argc - 1, argv + 1);
}
