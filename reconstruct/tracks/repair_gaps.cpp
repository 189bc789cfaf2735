// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/repair_gaps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/parallel.h"
#include "core/base/quantile.h"
#include "reconstruct/tracks/enforce_rigid_distances.h"
#include "reconstruct/tracks/gap_process.h"
#include "reconstruct/tracks/marker_distances.h"

namespace marey::reconstruct {
namespace {

// Pieces of a long gap: not shorter than this, and blended over twice the overlap.
constexpr double kMinPiece_s = 0.25;
constexpr double kOverlap_s = 0.1;

struct Gap {
  std::size_t marker = 0;
  FrameSpan span;
};

/// Estimate of a gap: nullopt for frames without one.
struct GapEstimate {
  std::vector<std::optional<MarkerSample>> samples;
  std::vector<std::size_t> carried_by;
  RepairMethod method = RepairMethod::kLeftEmpty;
};

std::vector<Gap> find_gaps(const MarkerTracks& tracks) {
  std::vector<Gap> gaps;
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    std::size_t seen = 0;
    for (std::size_t f = 0; f < tracks.frames(); ++f) seen += tracks.at(f, m) ? 1 : 0;
    if (seen == 0) {
      if (tracks.frames() > 0) gaps.push_back({m, {0, tracks.frames()}});
      continue;
    }
    for (std::size_t f = 0; f < tracks.frames(); ++f) {
      if (tracks.at(f, m)) continue;
      const std::size_t first = f;
      while (f < tracks.frames() && !tracks.at(f, m)) ++f;
      gaps.push_back({m, {first, f}});
    }
  }
  return gaps;
}

/// Interpolates linearly in gaps, and holds the first and the last sight: sufficient for
/// a first pass, in which these places have little weight.
std::vector<glm::dvec3> first_guess(const MarkerTracks& tracks,
                                    std::span<const Gap> gaps) {
  std::vector<glm::dvec3> guess(tracks.samples.size(), glm::dvec3(0.0));
  for (std::size_t i = 0; i < guess.size(); ++i) {
    if (tracks.samples[i]) guess[i] = tracks.samples[i]->p_in_world;
  }
  const std::size_t n = tracks.markers();
  for (const Gap& gap : gaps) {
    const bool before = gap.span.first > 0;
    const bool after = gap.span.end < tracks.frames();
    if (!before && !after) continue;
    const std::size_t from = before ? gap.span.first - 1 : gap.span.end;
    const std::size_t to = after ? gap.span.end : from;
    const glm::dvec3 a = guess[from * n + gap.marker];
    const glm::dvec3 b = guess[to * n + gap.marker];
    for (std::size_t f = gap.span.first; f < gap.span.end; ++f) {
      const double share =
          to > from ? static_cast<double>(f - from) / static_cast<double>(to - from)
                    : 0.0;
      guess[f * n + gap.marker] = a + share * (b - a);
    }
  }
  return guess;
}

/// Fills pieces of the span with enough companions each, halving those without.
void fill_pieces(const GapContext& trial,
                 std::size_t marker,
                 const FrameSpan& gap,
                 const FrameSpan& piece,
                 std::vector<std::pair<FrameSpan, GapFill>>& fills) {
  const auto minimum =
      static_cast<std::size_t>(std::lround(kMinPiece_s * trial.tracks.rate.hz));
  auto fill = fill_gap(trial, marker, gap, piece);
  if (fill) {
    fills.emplace_back(piece, std::move(*fill));
    return;
  }
  if (piece.size() < 2 * std::max<std::size_t>(1, minimum)) return;
  const std::size_t middle = piece.first + piece.size() / 2;
  fill_pieces(trial, marker, gap, {piece.first, middle}, fills);
  fill_pieces(trial, marker, gap, {middle, piece.end}, fills);
}

/// Fills a piece again with its overlaps into the gap; unchanged if that fails.
void widen(const GapContext& trial,
           std::size_t marker,
           const FrameSpan& gap,
           std::pair<FrameSpan, GapFill>& fill) {
  const auto overlap =
      static_cast<std::size_t>(std::lround(kOverlap_s * trial.tracks.rate.hz));
  FrameSpan wide = fill.first;
  wide.first = std::max(gap.first, wide.first - std::min(wide.first, overlap));
  wide.end = std::min(gap.end, wide.end + overlap);
  auto again = fill_gap(trial, marker, gap, wide);
  if (again) fill = {wide, std::move(*again)};
}

double ramp(std::size_t frame, const FrameSpan& piece, const FrameSpan& gap) {
  // The weight of a piece decreases towards its ends, unless these are the gap's own.
  double weight = 1.0;
  const double reach = 1.0 + static_cast<double>(piece.size()) / 4.0;
  if (piece.first > gap.first) {
    weight = std::min(weight, static_cast<double>(frame - piece.first + 1) / reach);
  }
  if (piece.end < gap.end) {
    weight = std::min(weight, static_cast<double>(piece.end - frame) / reach);
  }
  return weight;
}

/// Computes a cubic through the two samples on either side (Hermite, after Catmull and
/// Rom).
GapEstimate spline(const MarkerTracks& tracks, const Gap& gap) {
  GapEstimate estimate;
  estimate.samples.resize(gap.span.size());
  if (gap.span.first < 2 || gap.span.end + 1 >= tracks.frames()) return estimate;
  const auto& before = tracks.at(gap.span.first - 1, gap.marker);
  const auto& earlier = tracks.at(gap.span.first - 2, gap.marker);
  const auto& after = tracks.at(gap.span.end, gap.marker);
  const auto& later = tracks.at(gap.span.end + 1, gap.marker);
  if (!earlier || !later) return estimate;
  const auto length = static_cast<double>(gap.span.size() + 1);
  const glm::dvec3 start = length * (before->p_in_world - earlier->p_in_world);
  const glm::dvec3 stop = length * (later->p_in_world - after->p_in_world);
  estimate.method = RepairMethod::kSpline;
  for (std::size_t i = 0; i < gap.span.size(); ++i) {
    const double s = static_cast<double>(i + 1) / length;
    const double h1 = s * s * (3.0 - 2.0 * s);
    const glm::dvec3 p = (1.0 - h1) * before->p_in_world + h1 * after->p_in_world +
                         s * (1.0 - s) * (1.0 - s) * start - s * s * (1.0 - s) * stop;
    const glm::dvec3 straight = (1.0 - s) * before->p_in_world + s * after->p_in_world;
    MarkerSample sample;
    sample.p_in_world = p;
    // Its deviation from a straight line is a measure of its error.
    sample.sigma_m = static_cast<float>(0.001 + 0.5 * glm::distance(p, straight));
    estimate.samples[i] = sample;
  }
  return estimate;
}

GapEstimate estimate_gap(const GapContext& trial,
                         const Gap& gap,
                         const RepairOptions& options) {
  std::vector<std::pair<FrameSpan, GapFill>> fills;
  fill_pieces(trial, gap.marker, gap.span, gap.span, fills);
  if (fills.empty()) {
    const bool is_short = static_cast<double>(gap.span.size()) <=
                          options.max_spline_s * trial.tracks.rate.hz;
    if (is_short) return spline(trial.tracks, gap);
    return {std::vector<std::optional<MarkerSample>>(gap.span.size()), {}, {}};
  }
  GapEstimate estimate;
  estimate.samples.resize(gap.span.size());
  estimate.carried_by = fills.front().second.carried_by;
  estimate.method = RepairMethod::kCluster;
  std::vector<double> weights(gap.span.size(), 0.0);
  std::vector<glm::dvec3> sums(gap.span.size(), glm::dvec3(0.0));
  std::vector<double> sigmas(gap.span.size(), 0.0);
  const bool whole = fills.size() == 1 && fills.front().first.size() == gap.span.size();
  for (auto& fill : fills) {
    if (!whole) widen(trial, gap.marker, gap.span, fill);
    if (fill.second.method == RepairMethod::kStructure) {
      estimate.method = RepairMethod::kStructure;
    }
    for (std::size_t i = 0; i < fill.first.size(); ++i) {
      const double weight = ramp(fill.first.first + i, fill.first, gap.span);
      const std::size_t at = fill.first.first + i - gap.span.first;
      weights[at] += weight;
      sums[at] += weight * fill.second.p_in_world[i];
      sigmas[at] += weight * fill.second.sigma_m[i];
    }
  }
  for (std::size_t i = 0; i < gap.span.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    MarkerSample sample;
    sample.p_in_world = sums[i] / weights[i];
    sample.sigma_m = static_cast<float>(sigmas[i] / weights[i]);
    estimate.samples[i] = sample;
  }
  return estimate;
}

/// Writes the estimate into the tracks where its sigma is small enough.
GapRepair write_down(const Gap& gap,
                     const GapEstimate& estimate,
                     const RepairOptions& options,
                     MarkerTracks& tracks) {
  GapRepair repair{gap.marker,
                   gap.span.first,
                   gap.span.size(),
                   estimate.method,
                   estimate.carried_by,
                   0.0,
                   0.0};
  const bool between = gap.span.first > 0 && gap.span.end < tracks.frames();
  std::vector<double> sigmas;
  for (std::size_t i = 0; i < gap.span.size(); ++i) {
    auto sample = estimate.samples[i];
    if (!sample || sample->sigma_m > options.max_sigma_m) continue;
    sample->source = between ? Source::kRepaired : Source::kInferred;
    sigmas.push_back(sample->sigma_m);
    tracks.at(gap.span.first + i, gap.marker) = sample;
  }
  if (sigmas.empty()) {
    repair.method = RepairMethod::kLeftEmpty;
    repair.carried_by.clear();
    return repair;
  }
  repair.worst_sigma_m = *std::max_element(sigmas.begin(), sigmas.end());
  repair.median_sigma_m = median(std::move(sigmas));
  return repair;
}

}  // namespace

RepairedTracks repair_gaps(const MarkerTracks& tracks,
                           const RepairOptions& options,
                           const Progress& progress) {
  MAREY_ASSERT(tracks.rate.hz > 0.0 && options.passes >= 1);
  RepairedTracks repaired{tracks, {}};
  const std::vector<Gap> gaps = find_gaps(tracks);
  if (gaps.empty()) return repaired;
  const MarkerDistances distances(tracks);
  std::vector<glm::dvec3> estimated = first_guess(tracks, gaps);
  std::vector<GapEstimate> estimates(gaps.size());
  for (int pass = 0; pass < options.passes; ++pass) {
    if (progress) progress(pass, options.passes);
    const GapContext trial{tracks, distances, estimated};
    in_parallel(gaps.size(), options.threads, [&](std::size_t i) {
      estimates[i] = estimate_gap(trial, gaps[i], options);
    });
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      for (std::size_t k = 0; k < gaps[i].span.size(); ++k) {
        if (!estimates[i].samples[k]) continue;
        estimated[(gaps[i].span.first + k) * tracks.markers() + gaps[i].marker] =
            estimates[i].samples[k]->p_in_world;
      }
    }
  }
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    repaired.gaps.push_back(write_down(gaps[i], estimates[i], options, repaired.tracks));
  }
  enforce_rigid_distances(tracks, distances, repaired.tracks);
  if (progress) progress(options.passes, options.passes);
  return repaired;
}

}  // namespace marey::reconstruct
