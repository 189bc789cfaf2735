// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/close_cycle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "edit/ops/cycle_constraints.h"
#include "edit/ops/cycle_paths.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/pose.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

using retarget::FootPlace;

/// Rounding error of an instant. [frames]
constexpr double kSameInstant = 1e-9;
/// A body that travels less per cycle does not leave the places of its constraints.
constexpr double kStaysInPlace_m = 1e-6;

/// Signals of one cycle and its surroundings in the frame of the screw.
struct CycleChannels {
  CycleFrame frame;
  std::vector<glm::dvec3> hips;
  std::vector<glm::dquat> hips_turn;
  /// [joint][sample]: in the parent. The root's follows from the hips', which may be far
  /// from it.
  std::vector<std::vector<glm::dquat>> joints;
  std::array<std::vector<glm::dvec3>, 2> ankles;
  std::array<std::vector<glm::dquat>, 2> feet;
  std::array<std::vector<glm::dquat>, 2> toes;
};

struct CycleSamples {
  CycleFrame frame;
  EditState samples;
};

/// The cycle with as many frames around it as the blend needs and the motion has.
CycleSamples sample_cycle(const EditState& state, const CycleSpec& spec) {
  CycleSamples out;
  const int frames = cycle_frames(spec);
  const double step = spec.period_frames / frames;
  const int blend =
      std::max(1, static_cast<int>(std::lround(spec.blend_s * state.motion.rate.hz)));
  const double last = spec.first + spec.period_frames;
  const double room = state.frame_count() - 1 - last;
  MAREY_ASSERT(spec.first >= 0.0 && room >= -kSameInstant);
  const int before = static_cast<int>(std::floor(spec.first / step + kSameInstant));
  const int after = static_cast<int>(std::floor(room / step + kSameInstant));
  out.frame = {
      std::min(before, blend + 1), frames, std::min(after, blend + 1) + 1, blend};
  std::vector<double> at_frame;
  for (int k = -out.frame.before; k < frames + out.frame.after; ++k) {
    at_frame.push_back(std::clamp(spec.first + k * step, 0.0, state.frame_count() - 1.0));
  }
  out.samples = resample_state(state, at_frame, state.motion.rate.hz);
  return out;
}

double share_of(const CycleFrame& frame, std::size_t sample) {
  return (static_cast<double>(sample) - frame.before) / frame.frames;
}

/// World frames of the hips, one per frame.
std::vector<RigidTransform> hips_path(const Motion& motion, JointIndex hips) {
  std::vector<RigidTransform> out;
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    out.push_back(world[index(hips)]);
  }
  return out;
}

glm::dvec3 cycle_centre(const CycleSamples& cycle, const CycleSpec& spec) {
  const CycleScrew screw(spec.travel);
  const std::vector<RigidTransform> hips =
      hips_path(cycle.samples.motion, cycle.samples.map.hips());
  glm::dvec3 sum(0.0);
  for (int k = 0; k < cycle.frame.frames; ++k) {
    const auto t = static_cast<std::size_t>(cycle.frame.before + k);
    sum += inverse(screw.at(share_of(cycle.frame, t)))(hips[t].translation);
  }
  return sum / static_cast<double>(cycle.frame.frames);
}

CycleChannels channels_of(const CycleSamples& cycle, const CyclePaths& paths) {
  CycleChannels out;
  out.frame = cycle.frame;
  const Motion& motion = cycle.samples.motion;
  out.joints.resize(motion.skeleton.joints.size());
  std::array<std::vector<FootPlace>, 2> feet{foot_places(cycle.samples, 0),
                                             foot_places(cycle.samples, 1)};
  const std::vector<RigidTransform> hips = hips_path(motion, cycle.samples.map.hips());
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const PlanarMove home = inverse(paths.old_path(share_of(out.frame, t)));
    const glm::dquat turn = home.rotation();
    out.hips.push_back(home(hips[t].translation));
    out.hips_turn.push_back(turn * hips[t].rotation);
    for (std::size_t j = 0; j < out.joints.size(); ++j) {
      out.joints[j].push_back(motion.poses[t].parent_from_joint[j]);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      const FootPlace& place = feet[side][t];
      out.ankles[side].push_back(home(place.ankle_in_world));
      out.feet[side].push_back(turn * place.foot);
      out.toes[side].push_back(turn * place.toes);
    }
  }
  return out;
}

void make_periodic(CycleChannels& channels) {
  const CycleFrame& frame = channels.frame;
  make_periodic(std::span(channels.hips), frame);
  make_periodic(std::span(channels.hips_turn), frame);
  for (auto& joint : channels.joints) make_periodic(std::span(joint), frame);
  for (std::size_t side = 0; side < 2; ++side) {
    make_periodic(std::span(channels.ankles[side]), frame);
    make_periodic(std::span(channels.feet[side]), frame);
    make_periodic(std::span(channels.toes[side]), frame);
  }
}

/// For each frame of three cycles the share of the path that moves a foot: during a
/// stance that of its middle, so that a footprint moves as a whole; between stances it
/// runs from one to the next. Whole cycles are added to it from copy to copy. A foot that
/// always stands, or never, moves with the body.
std::vector<double> foot_shares(const Contacts& contacts, std::size_t side) {
  const int frames = contacts.frame_count;
  std::vector<double> out;
  for (int n = 0; n < 3 * frames; ++n) out.push_back(n);
  // Two more cycles, so that each frame lies between two whole stances.
  std::vector<FrameRange> runs = repeat_contacts(contacts, 5).feet[side].stance;
  std::erase_if(runs, [&](const FrameRange& run) {
    return run.first == 0 || run.last == 5 * frames - 1;
  });
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const FrameRange& run = runs[k];
    const double middle = 0.5 * (run.first + run.last);
    const bool is_last = k + 1 == runs.size();
    const int end = is_last ? run.last : runs[k + 1].first - 1;
    for (int n = run.first; n <= end; ++n) {
      const int of_three = n - frames;
      if (of_three < 0 || of_three >= 3 * frames) continue;
      double at = middle;
      if (n > run.last) {
        const double next = 0.5 * (runs[k + 1].first + runs[k + 1].last);
        const double share =
            static_cast<double>(n - run.last) / (runs[k + 1].first - run.last);
        at += (next - middle) * smooth_step(share);
      }
      out[static_cast<std::size_t>(of_three)] = at - frames;
    }
  }
  // Frames of the middle cycle.
  for (double& at : out) at = at / frames - 1.0;
  return out;
}

/// Three cycles on the new path, with planned feet; the middle one has shares 0 to 1.
struct ThreeCycles {
  EditState state;
  std::array<std::vector<std::optional<FootPlace>>, 2> feet;
};

/// Sets the root so that the hips have this frame in the world.
void put_hips(const Skeleton& skeleton,
              JointIndex hips,
              const RigidTransform& world_from_hips,
              Pose& pose) {
  RigidTransform root_from_hips;
  for (std::size_t j = index(hips); j != 0; j = index(*skeleton.joints[j].parent)) {
    const RigidTransform parent_from_joint{
        pose.parent_from_joint[j], skeleton.joints[j].parent_from_joint.translation};
    root_from_hips = parent_from_joint * root_from_hips;
  }
  const RigidTransform world_from_root = world_from_hips * inverse(root_from_hips);
  pose.root_in_world = world_from_root.translation;
  pose.parent_from_joint[0] = world_from_root.rotation;
}

ThreeCycles repeat_channels(const CycleChannels& channels,
                            const CyclePaths& paths,
                            const EditState& cycle) {
  ThreeCycles out;
  out.state.motion.skeleton = cycle.motion.skeleton;
  out.state.motion.rate = cycle.motion.rate;
  out.state.map = cycle.map;
  out.state.contacts = repeat_contacts(cycle.contacts, 3);
  const int frames = channels.frame.frames;
  const std::array<std::vector<double>, 2> shares{foot_shares(cycle.contacts, 0),
                                                  foot_shares(cycle.contacts, 1)};
  for (int n = 0; n < 3 * frames; ++n) {
    const auto t = static_cast<std::size_t>(channels.frame.before + n % frames);
    // The path first, then whole steps: copies differ by rounding alone.
    const int copy = n / frames - 1;
    const double share = static_cast<double>(n % frames) / frames;
    const PlanarMove path = power(paths.step(), copy) * paths.new_path(share);
    Pose pose;
    for (const auto& joint : channels.joints) pose.parent_from_joint.push_back(joint[t]);
    const glm::dquat turn = path.rotation();
    put_hips(cycle.motion.skeleton,
             cycle.map.hips(),
             {turn * channels.hips_turn[t], path(channels.hips[t])},
             pose);
    out.state.motion.poses.push_back(std::move(pose));
    for (std::size_t side = 0; side < 2; ++side) {
      const double at = shares[side][static_cast<std::size_t>(n)] - copy;
      const PlanarMove foot = power(paths.step(), copy) * paths.new_path(at) *
                              inverse(paths.old_path(at)) * paths.old_path(share);
      const glm::dquat foot_turn = foot.rotation();
      out.feet[side].push_back(FootPlace{foot(channels.ankles[side][t]),
                                         foot_turn * channels.feet[side][t],
                                         foot_turn * channels.toes[side][t]});
    }
  }
  return out;
}

/// Moves from the source to the path of the result, by frame of the cycle.
std::vector<PlanarMove> path_moves(const CyclePaths& paths, int frames, bool in_place) {
  std::vector<PlanarMove> out;
  for (int k = 0; k < frames; ++k) {
    const double share = static_cast<double>(k) / frames;
    const PlanarMove move = paths.new_path(share) * inverse(paths.old_path(share));
    out.push_back(in_place ? paths.in_place(share) * move : move);
  }
  return out;
}

Motion moved_source(const CycleSamples& cycle, const std::vector<PlanarMove>& moves) {
  Motion out{cycle.samples.motion.skeleton, cycle.samples.motion.rate, 0, {}};
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const auto t = static_cast<std::size_t>(cycle.frame.before) + k;
    out.poses.push_back(cycle.samples.motion.poses[t]);
    move_pose(moves[k], out.poses.back());
  }
  return out;
}

void put_in_place(const CyclePaths& paths, EditState& cycle) {
  const int frames = cycle.frame_count();
  for (int k = 0; k < frames; ++k) {
    move_pose(paths.in_place(static_cast<double>(k) / frames),
              cycle.motion.poses[static_cast<std::size_t>(k)]);
  }
  for (FootContacts& foot : cycle.contacts.feet) {
    foot.heel.clear();
    foot.ball.clear();
    foot.stance.clear();
    foot.heel_up.clear();
  }
  cycle.contact_edits.clear();
}

std::vector<FrameRange> repeat_runs(const std::vector<FrameRange>& runs,
                                    int frames,
                                    int count) {
  std::vector<FrameRange> out;
  for (int copy = 0; copy < count; ++copy) {
    for (const FrameRange& run : runs) {
      const FrameRange moved{run.first + copy * frames, run.last + copy * frames};
      if (!out.empty() && out.back().last + 1 == moved.first && run.first == 0) {
        out.back().last = moved.last;
      } else {
        out.push_back(moved);
      }
    }
  }
  return out;
}

}  // namespace

int cycle_frames(const CycleSpec& spec) {
  return std::max(2, static_cast<int>(std::lround(spec.period_frames)));
}

Contacts repeat_contacts(const Contacts& contacts, int count) {
  Contacts out = contacts;
  out.frame_count = count * contacts.frame_count;
  for (FootContacts& foot : out.feet) {
    for (auto* runs : {&foot.heel, &foot.ball, &foot.stance, &foot.heel_up}) {
      *runs = repeat_runs(*runs, contacts.frame_count, count);
    }
  }
  return out;
}

ClosedCycle close_cycle(const EditState& state, const CycleSpec& spec) {
  const CycleSamples cycle = sample_cycle(state, spec);
  const int before = cycle.frame.before;
  const int frames = cycle.frame.frames;
  ClosedCycle out;
  out.cycle = slice_state(cycle.samples, {before, before + frames - 1});
  out.contacts = out.cycle.contacts;
  const CyclePaths paths(spec.travel, spec.drift, cycle_centre(cycle, spec));
  CycleChannels channels = channels_of(cycle, paths);
  make_periodic(channels);
  ThreeCycles three = repeat_channels(channels, paths, out.cycle);
  set_feet(three.state, three.feet);
  out.plant = plant_feet(three.state);
  out.travel = paths.step();
  const glm::dvec3 hips =
      paths.new_path(0.0)(channels.hips[static_cast<std::size_t>(before)]);
  out.travel_m = glm::distance(hips, out.travel(hips));
  for (int k = 0; k < frames; ++k) {
    out.cycle.motion.poses[static_cast<std::size_t>(k)] =
        three.state.motion.poses[static_cast<std::size_t>(frames + k)];
  }
  out.three = std::move(three.state.motion);
  const bool in_place = spec.drift == CycleDrift::kNone;
  const std::vector<PlanarMove> moves = path_moves(paths, frames, in_place);
  out.source = moved_source(cycle, moves);
  if (in_place) {
    put_in_place(paths, out.cycle);
  } else {
    out.step = out.travel;
  }
  out.dropped = carry_constraints(
      state, moves, out.source, in_place && out.travel_m > kStaysInPlace_m, out.cycle);
  return out;
}

}  // namespace marey::edit
