// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/clips/make_clip.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/clips/sample_clip.h"

#include "core/pose.h"
#include "retarget/body/normalized_skeleton.h"

namespace marey::engine {
namespace {

constexpr double kLoopAngle_rad = 2.0 * 3.14159265358979323846 / 180.0;
constexpr double kLoopDistance_m = 0.01;

// Fills up with the last knot, which is skipped when a curve is made: a further knot
// would change the path of the spine. Even knots if there are too many.
template <std::size_t N>
std::array<float, N> knots_of(std::set<float> places) {
  places.insert(0.0F);
  places.insert(1.0F);
  std::array<float, N> out{};
  if (places.size() > N) {
    for (std::size_t i = 0; i < N; ++i) {
      out[i] = static_cast<float>(i) / static_cast<float>(N - 1);
    }
    return out;
  }
  out.fill(1.0F);
  std::copy(places.begin(), places.end(), out.begin());
  return out;
}

void add_places(const retarget::SpineSection& section, std::set<float>& places) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(section.count); ++i) {
    places.insert(static_cast<float>(section.at[i]));
  }
}

std::string in_clip(const ClipSource& source) {
  return "clip \"" + source.name + "\"";
}

std::optional<Error> check_source(const ClipSource& source) {
  const auto refuse = [&](std::string cause, std::string next) {
    return bad_input(in_clip(source), std::move(cause), std::move(next));
  };
  if (source.name.empty()) {
    return refuse("the clip has no name", "give the file or the recipe a name");
  }
  if (source.motion.poses.size() < 2) {
    return refuse("the motion has fewer than two poses", "leave the clip out");
  }
  if (!(source.motion.rate.hz > 0.0) || !std::isfinite(source.motion.rate.hz)) {
    return refuse("the rate is not positive", "give the rate of the motion");
  }
  for (std::size_t i = 0; i < source.map.limbs.size(); ++i) {
    if (source.map.limbs[i]) continue;
    return refuse(
        "the body has no complete " + std::string(i == 0 ? "left" : "right") + " arm",
        "use a body with shoulders, elbows and wrists");
  }
  for (std::size_t t = 0; t < source.motion.poses.size(); ++t) {
    const Pose& pose = source.motion.poses[t];
    double sum = pose.root_in_world.x + pose.root_in_world.y + pose.root_in_world.z;
    for (const glm::dquat& q : pose.parent_from_joint) sum += q.w + q.x + q.y + q.z;
    if (!std::isfinite(sum)) {
      return refuse("frame " + std::to_string(t) + " has a number that is not finite",
                    "repair the motion or trim the frame");
    }
  }
  return std::nullopt;
}

void add_contacts(const ClipSource& source, MotionClip& clip) {
  const double rate = source.motion.rate.hz;
  const double duration = clip.duration_s();
  const auto add = [&](const std::vector<FrameRange>& runs, ClipFootPart part) {
    for (const FrameRange& run : runs) {
      const double start = std::max((run.first - 0.5) / rate, 0.0);
      const double end = std::min((run.last + 0.5) / rate, duration);
      if (end <= start) continue;
      clip.contacts[static_cast<std::size_t>(part)].push_back(
          {static_cast<float>(start), static_cast<float>(end)});
    }
  };
  add(source.contacts.feet[0].heel, ClipFootPart::kLeftHeel);
  add(source.contacts.feet[0].ball, ClipFootPart::kLeftBall);
  add(source.contacts.feet[1].heel, ClipFootPart::kRightHeel);
  add(source.contacts.feet[1].ball, ClipFootPart::kRightBall);
}

double largest_angle_rad(const BlendPosture& a, const BlendPosture& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < kUsedRotations; ++i) {
    const double dot =
        std::abs(static_cast<double>(a.x[i]) * static_cast<double>(b.x[i]) +
                 static_cast<double>(a.y[i]) * static_cast<double>(b.y[i]) +
                 static_cast<double>(a.z[i]) * static_cast<double>(b.z[i]) +
                 static_cast<double>(a.w[i]) * static_cast<double>(b.w[i]));
    worst = std::max(worst, 2.0 * std::acos(std::min(dot, 1.0)));
  }
  return worst;
}

// Closes a loop exactly, or returns an error if it is open.
std::optional<Error> close_loop(const ClipSource& source, MotionClip& clip) {
  const BlendPosture& first = clip.frames.front();
  BlendPosture& last = clip.frames.back();
  const double angle = largest_angle_rad(first, last);
  const double height_m =
      std::abs(static_cast<double>(first.height_legs - last.height_legs)) *
      source.map.leg_length_m;
  if (angle > kLoopAngle_rad || height_m > kLoopDistance_m) {
    return bad_input(
        in_clip(source),
        "the last posture differs from the first one by " +
            std::to_string(static_cast<int>(std::lround(angle * 57.29577951308232))) +
            " degrees and " +
            std::to_string(static_cast<int>(std::lround(1e3 * height_m))) + " mm",
        "make a cycle with the operation cyclify, or do not mark the clip as a loop");
  }
  last = first;
  return std::nullopt;
}

}  // namespace

PostureLayout choose_layout(std::span<const retarget::BodyMap> bodies) {
  std::set<float> abdomen;
  std::set<float> torso;
  std::set<float> neck;
  for (const retarget::BodyMap& map : bodies) {
    add_places(map.abdomen, abdomen);
    add_places(map.torso, torso);
    add_places(map.neck, neck);
  }
  return {knots_of<kAbdomenKnots>(std::move(abdomen)),
          knots_of<kTorsoKnots>(std::move(torso)),
          knots_of<kNeckKnots>(std::move(neck))};
}

Result<MotionClip> make_clip(const ClipSource& source, const PostureLayout& layout) {
  if (const auto error = check_source(source)) return *error;
  MotionClip clip;
  clip.name = source.name;
  clip.rate_hz = static_cast<float>(source.motion.rate.hz);
  clip.loops = source.loops;
  clip.tags = source.tags;
  std::sort(clip.tags.begin(), clip.tags.end());
  clip.tags.erase(std::unique(clip.tags.begin(), clip.tags.end()), clip.tags.end());
  clip.notes = source.annotations.notes;
  clip.constraints = source.constraints;
  clip.leg_length_m = static_cast<float>(source.map.leg_length_m);
  clip.body = source.body;
  clip.document_sha256 = source.document_sha256;
  clip.recipe_sha256 = source.recipe_sha256;

  std::vector<RigidTransform> world_from_joint(source.motion.skeleton.joints.size());
  retarget::NormalizedPose normalized;
  double heading_rad = 0.0;
  for (const Pose& pose : source.motion.poses) {
    world_from_joints(source.motion.skeleton, pose, world_from_joint);
    retarget::normalize(source.map, world_from_joint, normalized);
    BlendPosture posture;
    RootPlace root;
    from_normalized(normalized, layout, 1.0, heading_rad, posture, root);
    heading_rad = root.heading_rad;
    clip.frames.push_back(posture);
    clip.path.push_back({static_cast<float>(root.x_m),
                         static_cast<float>(root.z_m),
                         static_cast<float>(root.heading_rad)});
  }
  add_contacts(source, clip);
  if (clip.loops) {
    if (const auto error = close_loop(source, clip)) return *error;
  }
  return clip;
}

Result<MoveSet> make_moves(std::span<const ClipSource> sources) {
  std::vector<retarget::BodyMap> bodies;
  std::vector<const ClipSource*> ordered;
  for (const ClipSource& source : sources) {
    bodies.push_back(source.map);
    ordered.push_back(&source);
  }
  std::sort(ordered.begin(), ordered.end(), [](const ClipSource* a, const ClipSource* b) {
    return a->name < b->name;
  });
  MoveSet moves;
  moves.layout = choose_layout(bodies);
  for (const ClipSource* source : ordered) {
    if (!moves.clips.empty() && moves.clips.back().name == source->name) {
      return bad_input(in_clip(*source),
                       "two clips have this name",
                       "rename one of the files or recipes");
    }
    auto clip = make_clip(*source, moves.layout);
    if (!clip) return clip.error();
    moves.clips.push_back(*std::move(clip));
  }
  return moves;
}

}  // namespace marey::engine
