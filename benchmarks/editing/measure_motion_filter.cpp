// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures what the filter operation does to captured motions.
//
//   measure_motion_filter ../shared/data/mocap
//
// Motions: walk, run, jump and dances, as they are and with planted feet. Prints the
// largest displacement of bearing joints in contacts, the largest drift of a foot within
// a contact before and after, and the peaks of impacts: the largest vertical acceleration
// of the ankle within 25 ms of each impact, after over before (median, smallest). Then
// adds white noise (0.004 rad per joint and axis, 2 mm for the root; seeds 1 to 5) and
// prints the root mean square distance of all joints from the motion without it: noisy,
// filtered by splines, and by Butterworth filters at 6 Hz and by Winter's rule.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "edit/find/find_impacts.h"
#include "edit/ops/filter.h"
#include "edit/state/plant_feet.h"
#include <glm/geometric.hpp>

#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

using edit::EditState;

std::vector<glm::dvec3> joint_places(const Motion& motion, std::optional<JointIndex> of) {
  std::vector<glm::dvec3> out;
  if (!of) return out;
  for (const Pose& pose : motion.poses) {
    out.push_back(world_from_joints(motion.skeleton, pose)[index(*of)].translation);
  }
  return out;
}

EditState filtered(const FilterOp& op, const EditState& state) {
  EditOp with;
  with.parameters = op;
  const edit::EditInputs inputs;
  edit::OpReport report;
  auto made = edit::apply_filter(op, {with, 0, inputs}, state, report);
  if (made) return *std::move(made);
  std::fprintf(stderr, "%s\n", made.error().message().c_str());
  std::exit(3);
}

double moved_in_contacts_mm(const EditState& before, const EditState& after) {
  double worst = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& foot = before.contacts.feet[side];
    for (const bool heel : {true, false}) {
      const HumanBone ankle = side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
      const HumanBone toes = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
      const auto joint = before.map.joint_of[index(heel ? ankle : toes)];
      const auto old = joint_places(before.motion, joint);
      const auto now = joint_places(after.motion, joint);
      if (old.empty()) continue;
      for (const FrameRange& run : heel ? foot.heel : foot.ball) {
        for (int frame = run.first; frame <= run.last; ++frame) {
          const auto t = static_cast<std::size_t>(frame);
          worst = std::max(worst, 1e3 * glm::distance(old[t], now[t]));
        }
      }
    }
  }
  return worst;
}

double peak_near(const std::vector<glm::dvec3>& way, int frame, double hz) {
  const int reach = static_cast<int>(std::lround(0.025 * hz));
  double peak = 0.0;
  for (int t = std::max(frame - reach, 1);
       t <= std::min(frame + reach, static_cast<int>(way.size()) - 2);
       ++t) {
    const auto k = static_cast<std::size_t>(t);
    peak = std::max(peak, std::abs(way[k + 1].y - 2.0 * way[k].y + way[k - 1].y));
  }
  return peak;
}

/// Returns the peaks of impacts after over before, ascending.
std::vector<double> kept_peaks(const EditState& before, const EditState& after) {
  std::vector<double> out;
  for (int side = 0; side < 2; ++side) {
    const JointIndex ankle = before.map.leg(side).end;
    const auto old = joint_places(before.motion, ankle);
    const auto now = joint_places(after.motion, ankle);
    for (const int impact : edit::find_impacts(before, side)) {
      out.push_back(peak_near(now, impact, before.motion.rate.hz) /
                    peak_near(old, impact, before.motion.rate.hz));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

double error_mm(const Motion& motion, const Motion& truth) {
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const auto a = world_from_joints(motion.skeleton, motion.poses[t]);
    const auto b = world_from_joints(truth.skeleton, truth.poses[t]);
    for (std::size_t j = 0; j < a.size(); ++j, ++count) {
      const glm::dvec3 apart = a[j].translation - b[j].translation;
      squares += glm::dot(apart, apart);
    }
  }
  return 1e3 * std::sqrt(squares / static_cast<double>(count));
}

EditState with_noise(const EditState& state, std::uint64_t seed) {
  constexpr double kNoise_rad = 0.004;
  constexpr double kNoise_m = 0.002;
  testing::Dice dice(seed);
  const auto three = [&](double sigma) {
    return glm::dvec3(dice.noise(sigma), dice.noise(sigma), dice.noise(sigma));
  };
  EditState out = state;
  for (Pose& pose : out.motion.poses) {
    for (glm::dquat& q : pose.parent_from_joint) {
      q = q * rotation_from_vector(three(kNoise_rad));
    }
    pose.root_in_world += three(kNoise_m);
  }
  return out;
}

void add_contact_row(const std::string& name,
                     const EditState& state,
                     ResultTable& table) {
  const EditState made = filtered({}, state);
  const auto peaks = kept_peaks(state, made);
  table.rows.push_back({name,
                        state.motion.rate.hz,
                        moved_in_contacts_mm(state, made),
                        edit::measure_slide(state).worst_drift_mm,
                        edit::measure_slide(made).worst_drift_mm,
                        static_cast<double>(peaks.size()),
                        peaks.empty() ? 1.0 : peaks[peaks.size() / 2],
                        peaks.empty() ? 1.0 : peaks.front()});
}

void add_noise_row(const std::string& name, const EditState& state, ResultTable& table) {
  constexpr std::uint64_t kSeeds = 5;
  FilterOp six;
  six.method = FilterMethod::kButterworth;
  six.cutoff = CutoffRule::kGiven;
  six.cutoff_hz = 6.0;
  FilterOp winter;
  winter.method = FilterMethod::kButterworth;
  std::vector<double> sums(4, 0.0);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    // Contacts are those of the motion without noise.
    const EditState noisy = with_noise(state, seed);
    sums[0] += error_mm(noisy.motion, state.motion) / kSeeds;
    sums[1] += error_mm(filtered({}, noisy).motion, state.motion) / kSeeds;
    sums[2] += error_mm(filtered(six, noisy).motion, state.motion) / kSeeds;
    sums[3] += error_mm(filtered(winter, noisy).motion, state.motion) / kSeeds;
  }
  table.rows.push_back({name, sums[0], sums[1], sums[2], sums[3]});
}

int run(const std::filesystem::path& mocap) {
  ResultTable contacts{"filter_contacts",
                       "Feet and impacts after the filter",
                       {{"motion"},
                        {"Hz", 0},
                        {"moved in contacts mm", 4},
                        {"drift before mm", 2},
                        {"after", 2},
                        {"impacts", 0},
                        {"peak kept, median", 3},
                        {"smallest", 3}},
                       {},
                       {}};
  ResultTable noise{"filter_noise",
                    "Distance from the motion without noise, mm",
                    {{"motion"}, {"noisy", 2}, {"spline", 2}, {"6 Hz", 2}, {"Winter", 2}},
                    {},
                    {}};
  for (const auto& [file, name] :
       {std::pair{"cmu_asfamc/02_01.amc", "walk, CMU 02_01"},
        std::pair{"bandai/dataset-1_walk_normal_001.bvh", "walk, Bandai"},
        std::pair{"cmu_asfamc/02_03.amc", "run, CMU 02_03"},
        std::pair{"cmu_asfamc/02_04.amc", "jump, CMU 02_04"},
        std::pair{"bandai/dataset-1_dance-short_normal_001.bvh", "dance, Bandai"},
        std::pair{"cmu_bvh_tmoco/05_06.bvh", "dance, CMU 05_06"}}) {
    if (!std::filesystem::exists(mocap / file)) continue;
    const auto clip = read_clip(mocap / file, name);
    if (!clip) {
      std::fprintf(stderr, "%s\n", clip.error().message().c_str());
      return 3;
    }
    auto state = edit::make_edit_state(
        {clip->character.skeleton, {clip->rate_hz}, 0, clip->poses});
    if (!state) return 3;
    add_contact_row(name, *state, contacts);
    EditState planted = *state;
    edit::plant_feet(planted);
    add_contact_row(std::string(name) + ", planted", planted, contacts);
    add_noise_row(name, *state, noise);
  }
  print_table(contacts);
  print_table(noise);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: measure_motion_filter MOCAP_FOLDER\n");
    return 2;
  }
  return marey::run(argv[1]);
}
