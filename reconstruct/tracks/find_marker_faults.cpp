// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/find_marker_faults.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "reconstruct/tracks/marker_distances.h"

namespace marey::reconstruct {
namespace {

// Largest coordinate: a capture volume is at most a hall.
constexpr double kWorld_m = 200.0;
// A marker that is exactly still for this time, while its companions move this far, is
// frozen.
constexpr double kFrozen_s = 0.05;
constexpr std::size_t kMinFrozen = 4;
constexpr double kMovedOn_m = 0.01;
constexpr std::size_t kCompanions = 6;
constexpr std::size_t kMinCompanions = 3;
// Off by this many of the companions' own spreads, and this far.
constexpr double kFarOff = 6.0;
constexpr double kFarOff_m = 0.025;
// Lower limits for a short run between two jumps, which is suspect already.
constexpr double kOff = 1.5;
constexpr double kOff_m = 0.01;
constexpr double kMaxLeap_s = 1.0;
// From one frame to the next: nothing on a body is faster.
constexpr double kMaxSpeed_m_per_s = 12.0;
constexpr double kStep_m = 0.015;
constexpr double kApart_m_per_s = 3.0;  // In addition to its companions' speed.

/// Consecutive samples of one marker without a gap or a jump.
struct Run {
  std::size_t marker = 0;
  std::size_t first = 0;
  std::size_t end = 0;
  bool after_gap = false;
  bool before_gap = false;
};

/// Distance of a point from the place expected by the marker's companions: the median of
/// the differences of distances, and its usual size. [m]
struct Misplaced {
  double off_m = 0.0;
  double usual_m = 0.0;
  [[nodiscard]] bool is_far() const { return off_m > kFarOff * usual_m + kFarOff_m; }
  [[nodiscard]] bool is_off() const { return off_m > kOff * usual_m + kOff_m; }
};

class TrackChecker {
 public:
  explicit TrackChecker(const MarkerTracks& tracks) : checked_{tracks, {}} {}

  CheckedTracks check() {
    drop_impossible();
    drop_frozen();
    const MarkerDistances distances(checked_.tracks);
    distances_ = &distances;
    // Swaps are detectable only while both samples exist: swaps first.
    undo_exchanges(find_runs());
    drop_outliers(find_runs());
    std::stable_sort(checked_.findings.begin(),
                     checked_.findings.end(),
                     [](const FaultySamples& a, const FaultySamples& b) {
                       return std::pair(a.first, a.marker) < std::pair(b.first, b.marker);
                     });
    return std::move(checked_);
  }

 private:
  MarkerTracks& tracks() { return checked_.tracks; }

  void drop(std::size_t marker, std::size_t first, std::size_t end) {
    for (std::size_t f = first; f < end; ++f) tracks().at(f, marker).reset();
  }

  void drop_impossible() {
    for (std::size_t m = 0; m < tracks().markers(); ++m) {
      for (std::size_t f = 0; f < tracks().frames(); ++f) {
        const std::size_t first = f;
        while (f < tracks().frames() && is_impossible(tracks().at(f, m))) ++f;
        if (f == first) continue;
        drop(m, first, f);
        checked_.findings.push_back(
            {TrackFault::kNoNumber, m, std::nullopt, first, f - first, 0.0});
      }
    }
  }

  static bool is_impossible(const std::optional<MarkerSample>& sample) {
    if (!sample) return false;
    const glm::dvec3& p = sample->p_in_world;
    // Written so that a NaN is one too.
    return !(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kWorld_m);
  }

  void drop_frozen() {
    const auto minimum = std::max(
        kMinFrozen, static_cast<std::size_t>(std::lround(kFrozen_s * tracks().rate.hz)));
    for (std::size_t m = 0; m < tracks().markers(); ++m) {
      for (std::size_t f = 0; f + 1 < tracks().frames(); ++f) {
        const std::size_t first = f;
        while (f + 1 < tracks().frames() && stands(m, f)) ++f;
        if (f - first + 1 < minimum) continue;
        const double moved_m = others_moved_m(m, first, f);
        if (moved_m < kMovedOn_m) continue;
        // The first of them was still seen.
        drop(m, first + 1, f + 1);
        checked_.findings.push_back(
            {TrackFault::kFrozen, m, std::nullopt, first + 1, f - first, moved_m});
      }
    }
  }

  /// Returns true if the marker is exactly where it was one frame before.
  bool stands(std::size_t marker, std::size_t frame) {
    const auto& now = tracks().at(frame, marker);
    const auto& next = tracks().at(frame + 1, marker);
    return now && next && now->p_in_world == next->p_in_world;
  }

  /// Returns the median travel of the others; 0 for fewer than three.
  double others_moved_m(std::size_t marker, std::size_t first, std::size_t last) {
    std::vector<double> moved_m;
    for (std::size_t other = 0; other < tracks().markers(); ++other) {
      const auto& a = tracks().at(first, other);
      const auto& b = tracks().at(last, other);
      if (other == marker || !a || !b) continue;
      moved_m.push_back(glm::distance(a->p_in_world, b->p_in_world));
    }
    return moved_m.size() < kMinCompanions ? 0.0 : median(std::move(moved_m));
  }

  /// Returns the misplacement of `p` as a sample of `marker`; nullopt without enough
  /// companions.
  std::optional<Misplaced> misplaced(std::size_t frame,
                                     std::size_t marker,
                                     const glm::dvec3& p,
                                     std::optional<std::size_t> without) {
    std::vector<double> off_m;
    std::vector<double> usual_m;
    for (const std::size_t other : distances_->companions(marker)) {
      const auto& at = tracks().at(frame, other);
      if (!at || (without && other == *without)) continue;
      const auto& pair = distances_->between(marker, other);
      off_m.push_back(std::abs(glm::distance(p, at->p_in_world) - pair.mean_m));
      usual_m.push_back(std::sqrt(pair.variance_m2));
      if (off_m.size() == kCompanions) break;
    }
    if (off_m.size() < kMinCompanions) return std::nullopt;
    return Misplaced{median(std::move(off_m)), median(std::move(usual_m))};
  }

  /// Returns the misplacement of the samples of `from` in a run as samples of `marker`:
  /// medians over the run.
  std::optional<Misplaced> misplaced_run(const Run& run,
                                         std::size_t marker,
                                         std::size_t from,
                                         std::optional<std::size_t> without) {
    std::vector<double> off_m;
    std::vector<double> usual_m;
    const std::size_t step = std::max<std::size_t>(1, (run.end - run.first) / 200);
    for (std::size_t f = run.first; f < run.end; f += step) {
      const auto& sample = tracks().at(f, from);
      if (!sample) continue;
      const auto found = misplaced(f, marker, sample->p_in_world, without);
      if (!found) continue;
      off_m.push_back(found->off_m);
      usual_m.push_back(found->usual_m);
    }
    if (off_m.empty()) return std::nullopt;
    return Misplaced{median(std::move(off_m)), median(std::move(usual_m))};
  }

  /// Returns true if the marker moves further between two frames than its companions, and
  /// than a body can.
  bool jumps(std::size_t marker, std::size_t frame) {
    const auto& now = tracks().at(frame, marker);
    const auto& next = tracks().at(frame + 1, marker);
    const glm::dvec3 step = next->p_in_world - now->p_in_world;
    const double max_m = kStep_m + kMaxSpeed_m_per_s / tracks().rate.hz;
    glm::dvec3 carried(0.0);
    int companions = 0;
    for (const std::size_t other : distances_->companions(marker)) {
      const auto& a = tracks().at(frame, other);
      const auto& b = tracks().at(frame + 1, other);
      if (!a || !b || glm::distance(a->p_in_world, b->p_in_world) > max_m) continue;
      carried += b->p_in_world - a->p_in_world;
      if (++companions == static_cast<int>(kMinCompanions)) break;
    }
    if (companions > 0) carried /= companions;
    const double min_m = kStep_m + kApart_m_per_s / tracks().rate.hz;
    if (glm::length(step - carried) <= (companions > 0 ? min_m : max_m)) return false;
    // Fast movement continues before or after.
    const auto like = [&](std::size_t a, std::size_t b) {
      if (b >= tracks().frames() || !tracks().at(a, marker) || !tracks().at(b, marker)) {
        return false;
      }
      const glm::dvec3 other =
          tracks().at(b, marker)->p_in_world - tracks().at(a, marker)->p_in_world;
      return glm::length(step - other) <= min_m;
    };
    const bool came = frame > 0 && like(frame - 1, frame);
    return !came && !like(frame + 1, frame + 2);
  }

  std::vector<Run> find_runs() {
    std::vector<Run> runs;
    for (std::size_t m = 0; m < tracks().markers(); ++m) {
      std::size_t f = 0;
      bool after_gap = true;
      while (f < tracks().frames()) {
        if (!tracks().at(f, m)) {
          after_gap = true;
          ++f;
          continue;
        }
        Run run{m, f, f, after_gap, true};
        while (f < tracks().frames() && tracks().at(f, m)) {
          ++f;
          if (f < tracks().frames() && tracks().at(f, m) && jumps(m, f - 1)) {
            run.before_gap = false;
            break;
          }
        }
        run.end = f;
        after_gap = run.before_gap;
        runs.push_back(run);
      }
    }
    return runs;
  }

  void undo_exchanges(const std::vector<Run>& runs) {
    for (const Run& run : runs) {
      const auto as_it_is = misplaced_run(run, run.marker, run.marker, std::nullopt);
      if (!as_it_is || !as_it_is->is_far()) continue;
      const auto other = find_partner(run, *as_it_is);
      if (!other) continue;
      for (std::size_t f = run.first; f < run.end; ++f) {
        std::swap(tracks().at(f, run.marker), tracks().at(f, *other));
      }
      checked_.findings.push_back({TrackFault::kExchanged,
                                   run.marker,
                                   other,
                                   run.first,
                                   run.end - run.first,
                                   as_it_is->off_m});
    }
  }

  /// Returns the marker that is at the expected place of this one, and at no better place
  /// itself.
  std::optional<std::size_t> find_partner(const Run& run, const Misplaced& as_it_is) {
    std::optional<std::size_t> best;
    double min_m = 0.5 * as_it_is.off_m;
    for (std::size_t other = 0; other < tracks().markers(); ++other) {
      if (other == run.marker) continue;
      const auto here = misplaced_run(run, run.marker, other, other);
      if (!here || here->is_far() || here->off_m > min_m) continue;
      const auto there = misplaced_run(run, other, run.marker, run.marker);
      if (!there || there->is_far()) continue;
      const auto now = misplaced_run(run, other, other, run.marker);
      if (now && !now->is_far() && now->off_m < there->off_m) continue;
      best = other;
      min_m = here->off_m;
    }
    return best;
  }

  void drop_outliers(const std::vector<Run>& runs) {
    struct Stray {
      Run run;
      double off_m;
    };
    std::vector<Stray> strays;
    for (const Run& run : runs) {
      const auto found = misplaced_run(run, run.marker, run.marker, std::nullopt);
      if (!found) continue;
      const bool leaps =
          !run.after_gap && !run.before_gap &&
          static_cast<double>(run.end - run.first) < kMaxLeap_s * tracks().rate.hz;
      if (found->is_far() || (leaps && found->is_off())) {
        strays.push_back({run, found->off_m});
      }
    }
    for (const auto& [run, off_m] : strays) {
      drop(run.marker, run.first, run.end);
      const bool alone = run.after_gap && run.before_gap;
      checked_.findings.push_back({alone ? TrackFault::kGhost : TrackFault::kJump,
                                   run.marker,
                                   std::nullopt,
                                   run.first,
                                   run.end - run.first,
                                   off_m});
    }
  }

  CheckedTracks checked_;
  const MarkerDistances* distances_ = nullptr;
};

}  // namespace

std::string_view name(TrackFault fault) {
  switch (fault) {
    case TrackFault::kNoNumber:
      return "no-number";
    case TrackFault::kFrozen:
      return "frozen";
    case TrackFault::kExchanged:
      return "swapped";
    case TrackFault::kGhost:
      return "ghost";
    case TrackFault::kJump:
      return "jump";
  }
  return "jump";
}

CheckedTracks find_marker_faults(const MarkerTracks& tracks) {
  MAREY_ASSERT(tracks.rate.hz > 0.0);
  return TrackChecker(tracks).check();
}

}  // namespace marey::reconstruct
