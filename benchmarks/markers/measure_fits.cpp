// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// How often is a fit to labelled markers wrong without a message? The input is simulated
// people by seed (tests/support/bodies/labelled_wearer.h), half of them with a common
// mistake:
//
//   measure_fits FIRST COUNT
//
// One line per seed, then the table: sessions that are wrong and pass (a limb's joint
// more than 60 mm off, or by more than 5 of its standard deviations and 25 mm, in a tenth
// of the frames or more that mark it as measured), mistakes that pass, and right sessions
// that are refused, by cause. The checks are the same as in `marey fit`:
// app/markers/trial_checks.cpp, app/markers/label_checks.cpp and
// app/markers/assess_fit.cpp. At the end the shares of errors inside the 95 % of their
// standard deviations: of joints, and of markers that were hidden.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "app/markers/assess_fit.h"
#include "app/markers/complete_markers.h"
#include "app/markers/label_checks.h"
#include "app/markers/trial_checks.h"
#include "benchmarks/markers/fit_honesty.h"
#include "core/pose.h"
#include "reconstruct/tracks/repair_gaps.h"
#include "tests/support/bodies/labelled_wearer.h"

namespace marey {
namespace {

using benchmarks::FitHonesty;
using reconstruct::find_landmark;
using reconstruct::Landmark;
using reconstruct::NamedMarker;
using testing::exchange;

/// A wearer with the landmarks of its labels.
struct NamedWearer : testing::LabelledWearer {
  std::vector<NamedMarker> labels;
};

NamedWearer wearer(int seed) {
  const auto place_of = [](const std::string& name) {
    const Landmark* landmark = find_landmark(name);
    return testing::WornPlace{landmark->segment,
                              landmark->p_in_segment_per_stature,
                              landmark->sigma_per_stature};
  };
  NamedWearer out{testing::wearer(seed, place_of), {}};
  for (const auto& worn : out.LabelledWearer::labels) {
    out.labels.push_back({worn.label, find_landmark(worn.landmark)});
  }
  return out;
}

/// A change to a session.
enum class Mistake {
  kNone,
  kInTrial,
  kInAll,
  kLegs,
  kMovedMarker,
  kUnknown,
  kSidesInTrial,
  kLegsInTrial,
  kArmsInTrial,
  kUnitOfTrial
};
constexpr std::array kMistakes{"none",
                               "two labels exchanged in a trial",
                               "two labels exchanged in all",
                               "legs exchanged in all",
                               "a marker glued elsewhere",
                               "labels without a meaning",
                               "left and right in a trial",
                               "legs exchanged in a trial",
                               "arms exchanged in a trial",
                               "a trial in another unit"};
constexpr std::array kLegs{"THI", "KNE", "KNM", "TIB", "ANK", "MED", "HEE", "TOE"};
constexpr std::array kArms{"UPA", "ELB", "FRM", "WRA", "WRB", "FIN"};
constexpr std::array kRest{"FHD", "BHD", "SHO", "ASI", "PSI"};

constexpr std::array<std::array<const char*, 2>, 8> kPairs{{{"LTHI", "LKNE"},
                                                            {"LKNE", "LKNM"},
                                                            {"RANK", "RMED"},
                                                            {"LKNE", "RKNE"},
                                                            {"RANK", "RHEE"},
                                                            {"LASI", "LPSI"},
                                                            {"RELB", "RWRA"},
                                                            {"LSHO", "RSHO"}}};

Mistake mistake_of(int seed) {
  if (seed % 2 == 0) return Mistake::kNone;
  return static_cast<Mistake>(1 + static_cast<std::size_t>(seed / 2) %
                                      (kMistakes.size() - 1));
}

template <std::size_t kCount>
void exchange_sides(MarkerTracks& tracks, const std::array<const char*, kCount>& parts) {
  for (const char* part : parts) {
    exchange(tracks, std::string("L") + part, std::string("R") + part);
  }
}

void make(Mistake mistake, int seed, NamedWearer& one) {
  const auto turn = static_cast<std::size_t>(seed) / (2 * (kMistakes.size() - 1));
  const auto& [a, b] = kPairs[turn % kPairs.size()];
  MarkerTracks& trial = one.trials[turn % one.trials.size()];
  switch (mistake) {
    case Mistake::kNone:
      break;
    case Mistake::kInTrial:
      exchange(trial, a, b);
      break;
    case Mistake::kInAll:
      for (MarkerTracks& tracks : one.trials) exchange(tracks, a, b);
      break;
    case Mistake::kLegs:
      for (MarkerTracks& tracks : one.trials) exchange_sides(tracks, kLegs);
      break;
    case Mistake::kSidesInTrial:
      exchange_sides(trial, kLegs);
      exchange_sides(trial, kArms);
      exchange_sides(trial, kRest);
      break;
    case Mistake::kLegsInTrial:
      exchange_sides(trial, kLegs);
      break;
    case Mistake::kArmsInTrial:
      exchange_sides(trial, kArms);
      break;
    case Mistake::kUnitOfTrial:
      testing::rescale(trial, std::array{0.001, 1000.0, 0.1, 1.0 / 2.54, 25.4}[turn % 5]);
      break;
    case Mistake::kMovedMarker: {
      MarkerTracks& tracks = one.trials[1];
      const auto at = std::find(tracks.labels.begin(), tracks.labels.end(), a);
      const auto column = static_cast<std::size_t>(at - tracks.labels.begin());
      for (std::size_t f = 0; f < tracks.frames(); ++f) {
        if (auto& sample = tracks.at(f, column)) sample->p_in_world.y += 0.08;
      }
      break;
    }
    case Mistake::kUnknown:
      for (reconstruct::NamedMarker& marker : one.labels) {
        if (marker.label == "LFIN" || marker.label == "RFIN" || marker.label == "LSHO") {
          marker.landmark = nullptr;
        }
      }
      break;
  }
}

struct Outcome {
  bool is_refused = false;
  std::string cause;
  double worst_m = 0.0;  ///< The joint with the largest tenth of its errors.
  double worst_sigmas = 0.0;
  double stature_off = 0.0;  ///< In standard deviations.
};

/// Computes the 90 % quantile of a joint's errors over the frames that mark it as
/// measured.
void assess_joints(const NamedWearer& one,
                   std::size_t trial,
                   const reconstruct::SolvedMarkers& solved,
                   Outcome& out) {
  const Skeleton skeleton = make_humanoid(one.person.proportions);
  const EstimatedMotion& estimate = solved.estimate;
  for (const HumanBone bone : testing::limb_joints()) {
    std::vector<double> errors_m;
    std::vector<double> errors_sigmas;
    for (std::size_t f = 0; f < estimate.motion.poses.size(); f += 5) {
      const JointUncertainty& uncertainty = estimate.uncertainty[f][index(bone)];
      if (uncertainty.source != Source::kMeasured) continue;
      const double time_s = static_cast<double>(f) / one.trials[trial].rate.hz;
      const glm::dvec3 truth =
          world_from_joints(skeleton, one.movements[trial](time_s))[index(bone)]
              .translation;
      const glm::dvec3 ours = world_from_joints(estimate.motion.skeleton,
                                                estimate.motion.poses[f])[index(bone)]
                                  .translation;
      errors_m.push_back(glm::distance(truth, ours));
      errors_sigmas.push_back(errors_m.back() / (1.7320508 * uncertainty.sigma_m));
    }
    if (errors_m.size() < 5) continue;
    std::sort(errors_m.begin(), errors_m.end());
    std::sort(errors_sigmas.begin(), errors_sigmas.end());
    const std::size_t at = errors_m.size() * 9 / 10;
    out.worst_m = std::max(out.worst_m, errors_m[at]);
    if (errors_m[at] > 0.025) {
      out.worst_sigmas = std::max(out.worst_sigmas, errors_sigmas[at]);
    }
  }
}

void refuse(Outcome& out, const std::string& cause) {
  if (!out.is_refused) out.cause = cause;
  out.is_refused = true;
}

/// Returns the labels as in app::fit, with known landmarks.
app::FitLabels fit_labels(const NamedWearer& one) {
  app::FitLabels labels;
  for (const NamedMarker& marker : one.labels) {
    labels.labels.push_back(marker.label);
    labels.names.landmarks.push_back(marker.landmark);
    labels.names.is_computed.push_back(false);
    labels.samples.push_back(one.trials[0].frames());
  }
  return labels;
}

void refuse_all(Outcome& out, std::span<const Finding> findings) {
  for (const Finding& finding : findings) refuse(out, finding.cause);
}

Outcome run(int seed, Mistake mistake, FitHonesty& honesty) {
  NamedWearer one = wearer(seed);
  make(mistake, seed, one);
  Outcome out;
  std::vector<app::MarkerTrial> trials(one.trials.size());
  for (std::size_t t = 0; t < trials.size(); ++t) {
    trials[t].name = trials[t].path = "trial " + std::to_string(t);
    trials[t].labels = one.trials[t].labels;
    trials[t].repair.as_read = trials[t].repair.repaired.tracks = one.trials[t];
  }
  const auto geometry = reconstruct::compare_trials(one.trials, one.labels);
  if (const Status ok = app::check_units(trials, geometry); !ok) {
    refuse(out, ok.error().cause);
  }
  if (out.is_refused) return out;
  const app::FitLabels labels = fit_labels(one);
  app::LabelledFit subject;
  {
    auto fit = app::fit_subject_to({}, one.trials, labels, {});
    refuse_all(out, app::assess_sides_and_axes(trials, geometry));
    if (!fit) {
      refuse(out, "no fit");
      return out;
    }
    subject = *std::move(fit);
  }
  const Body& body = subject.fit.body;
  app::solve_trials(body, trials, {});
  for (std::size_t t = 0; t < trials.size(); ++t) {
    if (trials[t].solved) assess_joints(one, t, *trials[t].solved, out);
  }
  if (!out.is_refused) {
    refuse_all(out, app::assess_fit(trials, &subject, body, {}));
    const auto checks = app::find_label_faults(body, {}, &subject, labels, trials);
    refuse_all(out, app::assess_labels(checks, trials));
  }
  if (mistake == Mistake::kNone && !out.is_refused) {
    for (std::size_t t = 0; t < trials.size(); ++t) {
      honesty.add_joints(one.person, one.movements[t], *trials[t].solved);
      honesty.add_hidden_markers(seed, body, one.trials[t]);
    }
  }
  if (const auto& measured = subject.fit.measured_stature) {
    out.stature_off = (measured->stature_m - one.person.stature_m) / measured->sigma_m;
  }
  return out;
}

int measure(int first, int count) {
  std::array<std::array<int, 3>, kMistakes.size()> table{};
  int within = 0;
  FitHonesty honesty;
  for (int seed = first; seed < first + count; ++seed) {
    const Mistake mistake = mistake_of(seed);
    const Outcome out = run(seed, mistake, honesty);
    const bool is_wrong = out.worst_m > 0.060 || out.worst_sigmas > 5.0;
    auto& row = table[static_cast<std::size_t>(mistake)];
    ++row[0];
    row[1] += out.is_refused ? 1 : 0;
    row[2] += !out.is_refused && is_wrong ? 1 : 0;
    within += std::abs(out.stature_off) < 2.0 ? 1 : 0;
    std::printf(
        "%4d %-32s %s%s, worst joint %.0f mm, %.1f sigmas, stature %+.1f sigmas\n",
        seed,
        kMistakes[static_cast<std::size_t>(mistake)],
        out.is_refused ? "refused: " : "passed",
        out.cause.c_str(),
        1e3 * out.worst_m,
        out.worst_sigmas,
        out.stature_off);
    std::fflush(stdout);
  }
  std::printf("\n%-32s sessions  refused  wrong and passed\n", "mistake");
  int silent = 0;
  for (std::size_t i = 0; i < kMistakes.size(); ++i) {
    std::printf(
        "%-32s %8d %8d %8d\n", kMistakes[i], table[i][0], table[i][1], table[i][2]);
    silent += table[i][2];
  }
  std::printf("statures within 2 sigmas: %d of %d\n", within, count);
  honesty.print();
  return silent == 0 ? 0 : 1;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: measure_fits FIRST COUNT\n");
    return 2;
  }
  return marey::measure(std::atoi(argv[1]), std::atoi(argv[2]));
}
