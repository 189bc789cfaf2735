// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/assess_labels.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "reconstruct/markers/find_exchanges.h"
#include "tests/support/bodies/labelled_wearer.h"

namespace marey::reconstruct {
namespace {

using marey::testing::exchange;

/// A subject with the names that the labels mean.
struct NamedWearer : marey::testing::LabelledWearer {
  std::vector<NamedMarker> labels;
};

NamedWearer wearer(int seed) {
  const auto place_of = [](const std::string& name) {
    const Landmark* landmark = find_landmark(name);
    return marey::testing::WornPlace{landmark->segment,
                                     landmark->p_in_segment_per_stature,
                                     landmark->sigma_per_stature};
  };
  NamedWearer out{marey::testing::wearer(seed, place_of), {}};
  for (const auto& worn : out.LabelledWearer::labels) {
    out.labels.push_back({worn.label, find_landmark(worn.landmark)});
  }
  return out;
}

struct Checked {
  MarkersFit fit;
  std::vector<FaultyLabel> of_fit;
  std::vector<FaultyLabel> of_trials;
};

Checked check(const NamedWearer& one) {
  Checked out;
  auto fit = fit_markers({}, one.trials, one.labels);
  EXPECT_TRUE(fit);
  if (!fit) return out;
  out.fit = *std::move(fit);
  std::vector<SolvedMarkers> solved;
  for (const MarkerTracks& tracks : one.trials) {
    auto trial = solve_markers(out.fit.body, tracks);
    EXPECT_TRUE(trial);
    if (!trial) return out;
    solved.push_back(*std::move(trial));
  }
  std::vector<CheckedTrial> trials;
  for (std::size_t t = 0; t < solved.size(); ++t) {
    trials.push_back({&one.trials[t], &solved[t]});
  }
  out.of_fit = assess_fit_labels(out.fit, one.labels);
  out.of_trials = assess_trial_labels(out.fit.body, one.labels, trials);
  return out;
}

TEST(AssessLabels, FindsNothingInRightLabels) {
  for (const int seed : {1, 2}) {
    const NamedWearer one = wearer(seed);
    const Checked checked = check(one);
    EXPECT_TRUE(checked.of_trials.empty()) << seed;
    EXPECT_TRUE(checked.of_fit.empty()) << seed;
    EXPECT_FALSE(find_exchange({}, one.trials, one.labels, checked.fit)) << seed;
  }
}

// Half a thigh's length apart, for a whole trial: the distance of all markers from the
// body hardly changes.
TEST(AssessLabels, NamesTwoMarkersThatAreExchangedInATrial) {
  for (const auto& [a, b] : std::array<std::pair<const char*, const char*>, 3>{
           {{"LTHI", "LKNE"}, {"RANK", "RTOE"}, {"LKNE", "RKNE"}}}) {
    NamedWearer one = wearer(4);
    exchange(one.trials[1], a, b);
    const Checked checked = check(one);
    const auto found = std::find_if(
        checked.of_trials.begin(), checked.of_trials.end(), [](const FaultyLabel& f) {
          return f.fault == LabelFault::kExchanged;
        });
    ASSERT_NE(found, checked.of_trials.end()) << a;
    const std::array<std::string, 2> names{found->label, found->other};
    EXPECT_TRUE(std::find(names.begin(), names.end(), a) != names.end()) << a;
    EXPECT_TRUE(std::find(names.begin(), names.end(), b) != names.end()) << b;
    EXPECT_LT(found->exchanged_m, 0.5 * found->off_m);
  }
}

TEST(AssessLabels, ProposesTheExchangeOfLabelsThatAreWrongInAllTrials) {
  for (const auto& [a, b] : std::array<std::pair<const char*, const char*>, 2>{
           {{"LKNE", "RKNE"}, {"LASI", "LPSI"}}}) {
    NamedWearer one = wearer(5);
    for (MarkerTracks& tracks : one.trials) exchange(tracks, a, b);
    const auto fit = fit_markers({}, one.trials, one.labels);
    ASSERT_TRUE(fit);
    const auto found = find_exchange({}, one.trials, one.labels, *fit);
    ASSERT_TRUE(found) << a;
    ASSERT_EQ(found->labels.size(), 1U) << a;
    const auto& [first, second] = found->labels[0];
    EXPECT_TRUE((first == a && second == b) || (first == b && second == a))
        << first << ", " << second;
  }
}

// Formerly listed in docs/limitations.md as undetected.
TEST(AssessLabels, ProposesToExchangeTheLegsOfAStandingTrial) {
  NamedWearer one = wearer(6);
  one.trials.resize(1);
  for (const char* label : {"THI", "KNE", "KNM", "TIB", "ANK", "MED", "HEE", "TOE"}) {
    exchange(one.trials[0], std::string("L") + label, std::string("R") + label);
  }
  const auto fit = fit_markers({}, one.trials, one.labels);
  ASSERT_TRUE(fit);
  const auto found = find_exchange({}, one.trials, one.labels, *fit);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->limbs, "the legs");
}

// A hand without named markers follows any marker on it: formerly a shoulder's marker
// without a meaning was placed there as measured.
TEST(AssessLabels, NoMarkerIsFoundOnALimbThatNothingPoses) {
  NamedWearer one = wearer(7);
  for (NamedMarker& marker : one.labels) {
    if (marker.landmark == nullptr) continue;
    const HumanBone bone = marker.landmark->segment;
    const bool is_unknown = marker.label == "LSHO" || marker.label == "RSHO" ||
                            bone == HumanBone::kLeftHand || bone == HumanBone::kRightHand;
    if (is_unknown) marker.landmark = nullptr;
  }
  const auto fit = fit_markers({}, one.trials, one.labels);
  ASSERT_TRUE(fit);
  for (const PlacedMarker& marker : fit->body.markers) {
    EXPECT_NE(marker.segment, HumanBone::kLeftHand) << marker.label;
    EXPECT_NE(marker.segment, HumanBone::kRightHand) << marker.label;
  }
}

TEST(FitMarkers, MeasuresHowTallPeopleAre) {
  int within = 0;
  constexpr int kPeople = 8;
  for (int seed = 10; seed < 10 + kPeople; ++seed) {
    NamedWearer one = wearer(seed);
    one.trials.resize(1);
    const auto fit = fit_markers({}, one.trials, one.labels);
    ASSERT_TRUE(fit) << seed;
    ASSERT_TRUE(fit->measured_stature) << seed;
    const double off_m = fit->measured_stature->stature_m - one.person.stature_m;
    within += std::abs(off_m) < 2.0 * fit->measured_stature->sigma_m ? 1 : 0;
    // A twentieth: the deviation of proportions and of places of landmarks.
    EXPECT_LT(std::abs(off_m), 0.05 * one.person.stature_m) << seed;
  }
  EXPECT_GE(within, kPeople - 1);
}

}  // namespace
}  // namespace marey::reconstruct
