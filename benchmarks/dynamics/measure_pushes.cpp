// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// measure_pushes DATA
//
// Laws of a push against captured ones (docs/accuracy/dynamics.md): how well splines and
// the thesis' polynomial represent a push, how well one push is predicted from another
// of the same person, what a derivation costs, and how often the force law declines a
// push that a dense force could do. DATA is the shared data.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "dynamics/push/force_push.h"
#include "dynamics/push/thesis_push.h"

#include "benchmarks/dynamics/captured_push.h"
#include "benchmarks/dynamics/jump_clips.h"
#include "core/base/quantile.h"
#include "core/base/stopwatch.h"

namespace marey {
namespace {

using dynamics::ForcePush;
using dynamics::PushEnds;
using dynamics::ThesisPush;

HeightError error_of(const CapturedPush& push, const ThesisPush& law) {
  return height_error(push, [&](double t_s) { return law.height_m(t_s); });
}

/// Ends of the thesis law: free fall at a touch-down, else no acceleration.
PushEnds thesis_ends(const CapturedPush& push) {
  PushEnds out = push.ends;
  if (push.from_touchdown) out.start_m_s2 = -out.gravity_m_s2;
  return out;
}

/// The polynomial through the captured lowest point, with acceleration 0 at take-off, or
/// with free fall there.
std::optional<HeightError> represent_by_polynomial(const CapturedPush& push,
                                                   bool falls_at_end) {
  PushEnds ends = thesis_ends(push);
  if (falls_at_end) ends.end_m_s2 = -ends.gravity_m_s2;
  if (!(push.lowest_at > 0.0 && push.lowest_at < 1.0)) return std::nullopt;
  const auto law = dynamics::thesis_push(ends, push.lowest_at, push.lowest_m);
  if (!law) return std::nullopt;
  return error_of(push, *law);
}

void print_representation(const std::vector<CapturedPush>& pushes) {
  std::printf("Represented, rms mm (ends given)\n%-22s %8s", "push", "duration");
  for (const int n : {8, 10, 12, 14}) std::printf(" %5d", n);
  std::printf("  thesis (acceleration 0, free fall at take-off)\n");
  double worst_mm = 0.0;
  for (const CapturedPush& push : pushes) {
    if (push.kind == "run") continue;
    std::printf("%-22s %6.3f s", push.name.c_str(), push.ends.duration_s);
    for (const int n : {8, 10, 12, 14}) {
      const double rms_mm = represent_by_splines(push, n).rms_mm;
      if (n == dynamics::kForceCoefficients) worst_mm = std::max(worst_mm, rms_mm);
      std::printf(" %5.2f", rms_mm);
    }
    for (const bool falls : {false, true}) {
      const auto thesis = represent_by_polynomial(push, falls);
      std::printf("  %6.1f", thesis ? thesis->rms_mm : NAN);
    }
    std::printf("\n");
  }
  std::printf("bar 4: %.2f mm with 12 coefficients, at most 1.5: %s\n",
              worst_mm,
              worst_mm <= 1.5 ? "met" : "MISSED");
  std::vector<double> of_steps;
  for (const CapturedPush& push : pushes) {
    if (push.kind == "run") of_steps.push_back(represent_by_splines(push, 12).rms_mm);
  }
  if (of_steps.empty()) return;
  std::printf("%zu running steps with 12 coefficients: median %.2f, worst %.2f mm\n",
              of_steps.size(),
              quantile(of_steps, 0.5),
              *std::max_element(of_steps.begin(), of_steps.end()));
}

/// Errors of one push predicted from another. [mm rms]
struct Prediction {
  std::optional<double> force_mm;
  std::optional<double> thesis_mm;
  double copy_mm = 0.0;       ///< Stretched in time, shifted to the start's height.
  double bent_copy_mm = 0.0;  ///< Also moved by a line to the end's height.
};

double stretched_height(const CapturedPush& from, double share) {
  const double t_s = share * from.ends.duration_s;
  const dynamics::PushReference& force = from.reference;
  const double duration_s = from.ends.duration_s;
  return from.ends.start_m + from.ends.start_m_s * t_s +
         duration_s * duration_s * dynamics::reference_twice(force, share) -
         0.5 * from.ends.gravity_m_s2 * t_s * t_s;
}

Prediction predict(const CapturedPush& push, const CapturedPush& from) {
  Prediction out;
  if (const auto law = dynamics::derive_push(from.reference, push.ends)) {
    out.force_mm =
        height_error(push, [&](double t_s) { return law->height_m(t_s); }).rms_mm;
  }
  const double lowest_m = push.ends.start_m + from.lowest_m - from.ends.start_m;
  const auto thesis = dynamics::choose_thesis_push(
      thesis_ends(push), dynamics::near_point_cost(from.lowest_at, lowest_m));
  if (thesis) out.thesis_mm = error_of(push, *thesis).rms_mm;
  const double t = push.ends.duration_s;
  const double shift_m = push.ends.start_m - stretched_height(from, 0.0);
  const double end_shift_m = push.ends.end_m - stretched_height(from, 1.0);
  out.copy_mm = height_error(push, [&](double t_s) {
                  return stretched_height(from, t_s / t) + shift_m;
                }).rms_mm;
  out.bent_copy_mm =
      height_error(push, [&](double t_s) {
        const double share = t_s / t;
        return stretched_height(from, share) + shift_m + share * (end_shift_m - shift_m);
      }).rms_mm;
  return out;
}

void print_pair(const CapturedPush& push, const CapturedPush& from) {
  const Prediction p = predict(push, from);
  std::printf(
      "%s from %s: force law %.1f, thesis law %.1f, copy %.1f, copy with both "
      "heights %.1f mm rms\n",
      push.name.c_str(),
      from.name.c_str(),
      p.force_mm.value_or(NAN),
      p.thesis_mm.value_or(NAN),
      p.copy_mm,
      p.bent_copy_mm);
}

struct Column {
  std::vector<double> all_mm;
  int declined = 0;
  void add(std::optional<double> value) {
    if (value) {
      all_mm.push_back(*value);
    } else {
      ++declined;
    }
  }
  void print(const char* name) const {
    if (all_mm.empty()) {
      std::printf("  %-24s declined all %d\n", name, declined);
      return;
    }
    double sum = 0.0;
    for (const double v : all_mm) sum += v;
    std::printf("  %-24s mean %6.1f  median %6.1f  worst %6.1f mm; declined %d\n",
                name,
                sum / static_cast<double>(all_mm.size()),
                quantile(all_mm, 0.5),
                *std::max_element(all_mm.begin(), all_mm.end()),
                declined);
  }
};

void print_predictions(const std::vector<CapturedPush>& pushes) {
  std::printf("\nPredicted from another push of the same person\n");
  std::vector<std::string> groups;
  for (const CapturedPush& push : pushes) {
    const std::string group = push.person + ", " + push.kind;
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) {
      groups.push_back(group);
    }
  }
  for (const std::string& group : groups) {
    Column force, thesis, copy, bent;
    int pairs = 0;
    for (const CapturedPush& push : pushes) {
      for (const CapturedPush& from : pushes) {
        if (&push == &from || push.person + ", " + push.kind != group ||
            from.person + ", " + from.kind != group) {
          continue;
        }
        ++pairs;
        const Prediction p = predict(push, from);
        force.add(p.force_mm);
        thesis.add(p.thesis_mm);
        copy.add(p.copy_mm);
        bent.add(p.bent_copy_mm);
        if (push.kind == "jump") print_pair(push, from);
      }
    }
    if (pairs == 0) continue;
    std::printf("%s: %d pairs\n", group.c_str(), pairs);
    if (group == "DJ, jump" && !force.all_mm.empty()) {
      const double worst = *std::max_element(force.all_mm.begin(), force.all_mm.end());
      std::printf("bar 5: %.1f mm, at most 8: %s\n",
                  worst,
                  worst <= 8.0 && force.declined == 0 ? "met" : "MISSED");
    }
    force.print("force law");
    thesis.print("thesis law");
    copy.print("stretched copy");
    bent.print("copy with both heights");
  }
}

PushEnds with_rise(const PushEnds& ends, double ratio) {
  PushEnds out = ends;
  out.end_m_s *= std::sqrt(ratio);
  return out;
}

void print_changes(const std::vector<CapturedPush>& pushes) {
  std::printf("\nOther rises: lowest point moves, mm; peak of the force, g\n%-22s",
              "push");
  const std::vector<double> ratios{0.25, 0.5, 1.0, 1.5, 2.0};
  for (const double ratio : ratios) std::printf("  r = %4.2f      ", ratio);
  std::printf("\n");
  for (const CapturedPush& push : pushes) {
    if (push.kind == "run") continue;
    std::printf("%-22s", push.name.c_str());
    const auto lowest_of = [&](const ForcePush& law) {
      double lowest_m = 1e9;
      for (int i = 0; i <= 2000; ++i) {
        lowest_m = std::min(lowest_m, law.height_m(law.duration_s() * i / 2000.0));
      }
      return lowest_m;
    };
    for (const double ratio : ratios) {
      const auto law = dynamics::derive_push(push.reference, with_rise(push.ends, ratio));
      if (!law) {
        std::printf("  declined       ");
        continue;
      }
      std::printf("  %+6.1f  %5.2f g",
                  1e3 * (lowest_of(*law) - push.lowest_m),
                  law->extremes().max.force_m_s2 / push.ends.gravity_m_s2);
    }
    std::printf("\n");
  }
}

void print_cost(const std::vector<CapturedPush>& pushes) {
  std::vector<double> free_us, bound_us;
  for (const CapturedPush& push : pushes) {
    for (const double ratio : {0.25, 0.5, 0.8, 1.0, 1.2, 1.5, 2.0}) {
      for (const bool limited : {false, true}) {
        const PushEnds ends = with_rise(push.ends, ratio);
        dynamics::ForceLimits limits;
        if (limited) limits.max_force_m_s2 = 3.0 * ends.gravity_m_s2;
        // The least of several batches: other programs share the machine.
        constexpr int kRepeats = 50;
        double us = 1e9;
        bool is_derived = true;
        for (int batch = 0; batch < 10; ++batch) {
          const Stopwatch watch;
          for (int i = 0; i < kRepeats; ++i) {
            is_derived =
                is_derived && dynamics::derive_push(push.reference, ends, limits);
          }
          us = std::min(us, 1e6 * watch.seconds() / kRepeats);
        }
        if (!is_derived) continue;
        const auto law = dynamics::derive_push(push.reference, ends, limits);
        const auto [min, max] = law->extremes();
        // A take-off has force 0 by itself.
        const bool is_inside = min.at > 0.02 && min.at < 0.98;
        const bool bounded = (is_inside && min.force_m_s2 < 1e-4 && ratio != 1.0) ||
                             (limited && max.force_m_s2 > *limits.max_force_m_s2 - 1e-4);
        (bounded ? bound_us : free_us).push_back(us);
      }
    }
  }
  for (const auto& [name, all] : {std::pair{"free", free_us}, {"at a limit", bound_us}}) {
    if (all.empty()) continue;
    std::printf("%s: %zu pushes, median %.1f, 90 %% %.1f, worst %.1f us\n",
                name,
                all.size(),
                quantile(all, 0.5),
                quantile(all, 0.9),
                *std::max_element(all.begin(), all.end()));
  }
}

/// Draws ends inside the reachable range, by their share of it, and counts those for
/// which 12 coefficients do not suffice.
void print_border(const std::vector<CapturedPush>& pushes) {
  std::printf(
      "\nReachable end speeds that the force law declines, by the place in the "
      "reachable range (largest force 1.3 times the peak)\n");
  std::mt19937 random(1);
  for (const auto& [low, high] : {std::pair{0.0, 0.01},
                                  {0.01, 0.05},
                                  {0.05, 0.1},
                                  {0.1, 0.3},
                                  {0.3, 0.7},
                                  {0.7, 0.9},
                                  {0.9, 0.95},
                                  {0.95, 0.99},
                                  {0.99, 1.0}}) {
    int declined = 0;
    int all = 0;
    for (const CapturedPush& push : pushes) {
      const double peak_m_s2 = *std::max_element(push.reference.force_m_s2.begin(),
                                                 push.reference.force_m_s2.end());
      const double limit_m_s2 = std::max(1.3 * peak_m_s2, 2.5 * push.ends.gravity_m_s2);
      const auto range = dynamics::reachable_end_speeds(push.ends, limit_m_s2);
      if (!range) continue;
      for (int i = 0; i < 20; ++i) {
        const double share =
            low + (high - low) * static_cast<double>(random()) / 4294967296.0;
        PushEnds ends = push.ends;
        ends.end_m_s = range->min_m_s + share * (*range->max_m_s - range->min_m_s);
        ++all;
        const auto law =
            dynamics::derive_push(push.reference, ends, {.max_force_m_s2 = limit_m_s2});
        if (!law) ++declined;
      }
    }
    std::printf("  %4.0f to %3.0f %%: %5.1f %% of %d\n",
                100.0 * low,
                100.0 * high,
                100.0 * declined / std::max(all, 1),
                all);
  }
}

int measure(const std::filesystem::path& data) {
  std::vector<CapturedPush> pushes;
  for (const JumpClip& clip : jump_clips(data)) {
    for (CapturedPush& push : captured_pushes(clip)) pushes.push_back(std::move(push));
  }
  print_representation(pushes);
  print_predictions(pushes);
  print_changes(pushes);
  std::printf("\nCost of derive_push()\n");
  print_cost(pushes);
  print_border(pushes);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: measure_pushes DATA\n");
    return 2;
  }
  return marey::measure(arguments[1]);
}
