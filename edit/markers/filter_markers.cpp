// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/filter_markers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "edit/filter/channel_filter.h"
#include "edit/ops/filter.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/op_weights.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/format_text.h"
#include "core/signal/choose_smoothing.h"

namespace marey::edit {
namespace {

using MarkerChannels = std::vector<std::vector<double>>;

/// Returns the turn about the vertical whose X axis is the longest horizontal axis of a
/// marker's path.
glm::dquat path_axes(const MarkerTracks& tracks, std::size_t marker) {
  glm::dvec3 mean(0.0);
  double count = 0.0;
  for (std::size_t t = 0; t < tracks.frames(); ++t) {
    if (!tracks.at(t, marker)) continue;
    mean += tracks.at(t, marker)->p_in_world;
    count += 1.0;
  }
  mean /= std::max(count, 1.0);
  double along = 0.0;
  double across = 0.0;
  for (std::size_t t = 0; t < tracks.frames(); ++t) {
    if (!tracks.at(t, marker)) continue;
    const glm::dvec3 p = tracks.at(t, marker)->p_in_world - mean;
    along += p.x * p.x - p.z * p.z;
    across += 2.0 * p.x * p.z;
  }
  return glm::angleAxis(-0.5 * std::atan2(across, along), glm::dvec3(0.0, 1.0, 0.0));
}

/// The coordinates of one marker along its own axes.
struct OwnChannels {
  glm::dquat axes;
  glm::dvec3 start{0.0};
  MarkerChannels values;  ///< 0 in gaps.

  OwnChannels(const MarkerTracks& tracks, std::size_t marker, std::size_t first_seen)
      : axes(path_axes(tracks, marker)),
        start(tracks.at(first_seen, marker)->p_in_world),
        values(3, std::vector<double>(tracks.frames(), 0.0)) {
    for (std::size_t t = 0; t < tracks.frames(); ++t) {
      if (!tracks.at(t, marker)) continue;
      const glm::dvec3 p =
          glm::conjugate(axes) * (tracks.at(t, marker)->p_in_world - start);
      for (int axis = 0; axis < 3; ++axis) {
        values[static_cast<std::size_t>(axis)][t] = p[axis];
      }
    }
  }
  [[nodiscard]] glm::dvec3 in_world(const MarkerChannels& filtered, std::size_t t) const {
    return start + axes * glm::dvec3(filtered[0][t], filtered[1][t], filtered[2][t]);
  }
};

/// Returns a weight per frame; empty: all are equal.
std::vector<double> sample_weights(const MarkerTracks& tracks, std::size_t marker) {
  constexpr double kNotMeasured = 0.1;
  std::vector<double> out(tracks.frames(), 1.0);
  bool has_measured = false;
  bool has_others = false;
  for (std::size_t t = 0; t < out.size(); ++t) {
    const auto& sample = tracks.at(t, marker);
    if (!sample) continue;
    const bool is_measured = sample->source == Source::kMeasured;
    has_measured |= is_measured;
    has_others |= !is_measured;
    if (!is_measured) out[t] = kNotMeasured;
  }
  if (!has_measured || !has_others) out.clear();
  return out;
}

/// Returns the median over the axes of the removed part's root mean square.
double removed_rms(const MarkerChannels& before,
                   const MarkerChannels& after,
                   const std::vector<FrameRange>& pieces) {
  std::vector<double> rms;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double squares = 0.0;
    double count = 0.0;
    for (const FrameRange& piece : pieces) {
      for (int t = piece.first; t <= piece.last; ++t) {
        const auto i = static_cast<std::size_t>(t);
        const double removed = after[axis][i] - before[axis][i];
        squares += removed * removed;
        count += 1.0;
      }
    }
    rms.push_back(count > 0.0 ? std::sqrt(squares / count) : 0.0);
  }
  std::sort(rms.begin(), rms.end());
  return rms[1];
}

/// Displacement of one marker by the filter.
struct Displacement {
  double squares_m2 = 0.0;
  std::size_t count = 0;
  double largest_m = 0.0;
  std::size_t frame = 0;
};

/// Markers and samples that the filter leaves as they are.
struct LeftMarkers {
  std::vector<std::string> never_seen;
  std::vector<std::string> too_short;
  std::vector<std::string> constant;
  std::size_t samples = 0;  ///< Samples in pieces that are too short.
};

/// Filters all markers of a state into `out`.
class MarkerFilter {
 public:
  MarkerFilter(const FilterOp& op, const OpWeights& weights, MarkerState& out)
      : op_(op), weights_(weights), out_(out) {}

  void run(const MarkerState& state, OpReport& report) {
    for (std::size_t m = 0; m < state.tracks.markers(); ++m) {
      filter_one(state.tracks, m, report);
    }
    report.figures.emplace_back("displaced_mm", 1e3 * largest_.largest_m);
    report.figures.emplace_back("filtered_markers", filtered_);
    report.figures.emplace_back("left_samples", static_cast<double>(left_.samples));
    report_left(report);
    report_outlier(state.tracks, report);
  }

 private:
  void filter_one(const MarkerTracks& tracks, std::size_t marker, OpReport& report) {
    const std::string& label = tracks.labels[marker];
    const std::vector<FrameRange> runs = seen_runs(tracks, marker);
    if (runs.empty()) return left_.never_seen.push_back(label);
    const auto is_long = [](const FrameRange& run) {
      return run.last - run.first + 1 >= static_cast<int>(kMinSmoothingSamples);
    };
    if (std::none_of(runs.begin(), runs.end(), is_long)) {
      return left_.too_short.push_back(label);
    }
    const OwnChannels own(tracks, marker, static_cast<std::size_t>(runs[0].first));
    ChannelFilter filter(
        op_, own.values, sample_weights(tracks, marker), runs, tracks.rate.hz);
    if (!filter.cutoff_hz()) return left_.constant.push_back(label);
    MarkerChannels filtered = own.values;
    filter.run(filtered);
    std::vector<FrameRange> pieces;
    for (const FrameRange& run : runs) {
      const int frames = run.last - run.first + 1;
      const auto length = static_cast<std::size_t>(frames);
      if (length >= ChannelFilter::min_piece(op_)) {
        pieces.push_back(run);
      } else {
        left_.samples += length;
      }
    }
    Displacement moved;
    for (const FrameRange& piece : pieces) {
      for (int t = piece.first; t <= piece.last; ++t) {
        const auto frame = static_cast<std::size_t>(t);
        move(marker, frame, own.in_world(filtered, frame), moved);
      }
    }
    ++filtered_;
    if (moved.largest_m > largest_.largest_m) {
      largest_ = moved;
      largest_marker_ = marker;
    }
    const double noise_m =
        removed_rms(own.values, filtered, pieces) / filter.removed_noise_share();
    const auto add = [&](const char* figure, double value) {
      report.figures.emplace_back(label + figure, value);
    };
    add("_cutoff_hz", *filter.cutoff_hz());
    add("_noise_mm", 1e3 * noise_m);
    add("_removed_rms_mm",
        1e3 * std::sqrt(moved.squares_m2 / static_cast<double>(moved.count)));
    add("_removed_max_mm", 1e3 * moved.largest_m);
    add("_removed_max_s", static_cast<double>(moved.frame) / tracks.rate.hz);
  }

  /// Moves one sample towards its filtered place by the weight of its frame.
  void move(std::size_t marker,
            std::size_t frame,
            const glm::dvec3& filtered,
            Displacement& moved) {
    constexpr double kInvented_m = 0.010;
    ++moved.count;
    const double weight = weights_.weight[frame];
    if (weight <= 0.0) return;
    MarkerSample& sample = *out_.tracks.at(frame, marker);
    const glm::dvec3 old = sample.p_in_world;
    sample.p_in_world = weight < 1.0 ? glm::mix(old, filtered, weight) : filtered;
    const double distance_m = glm::distance(old, sample.p_in_world);
    moved.squares_m2 += distance_m * distance_m;
    if (distance_m > kInvented_m) {
      sample.source = Source::kInferred;
      out_.lineage.frames[frame].trust = Source::kInferred;
    }
    if (distance_m <= moved.largest_m) return;
    moved.largest_m = distance_m;
    moved.frame = frame;
  }

  void report_left(OpReport& report) const {
    const auto add =
        [&](const char* id, const std::vector<std::string>& labels, const char* cause) {
          if (labels.empty()) return;
          report.findings.push_back({Severity::kNote, id, label_list(labels), cause, ""});
        };
    add("never_seen", left_.never_seen, "was never seen; there is nothing to filter");
    add("too_short",
        left_.too_short,
        "has no 20 consecutive frames, too few to separate noise from movement; left as "
        "it is");
    add("constant",
        left_.constant,
        "has no movement, or no noise that the method recognises; left as it is");
    if (left_.samples == 0) return;
    report.findings.push_back(
        {Severity::kNote,
         "short_pieces",
         "markers",
         format_text("%zu samples lie in pieces of fewer than %zu frames between gaps; "
                     "left as they are",
                     left_.samples,
                     ChannelFilter::min_piece(op_)),
         "fill the gaps first with marey repair"});
  }

  /// Noise does not move a marker so far: it jumps, or it was exchanged with another.
  void report_outlier(const MarkerTracks& tracks, OpReport& report) const {
    constexpr double kOutlier_m = 0.03;
    if (largest_.largest_m <= kOutlier_m) return;
    report.findings.push_back(
        fair_finding("outlier",
                     tracks.labels[largest_marker_],
                     format_text("the filter moved it by %.0f mm at %.2f s, more than "
                                 "noise does",
                                 1e3 * largest_.largest_m,
                                 static_cast<double>(largest_.frame) / tracks.rate.hz),
                     "look for jumps and exchanged markers with marey repair first")
            .measured(1e3 * largest_.largest_m, 1e3 * kOutlier_m, "mm"));
  }

  const FilterOp& op_;
  const OpWeights& weights_;
  MarkerState& out_;
  LeftMarkers left_;
  int filtered_ = 0;
  Displacement largest_;
  std::size_t largest_marker_ = 0;
};

}  // namespace

Result<MarkerState> filter_markers(const FilterOp& op,
                                   const MarkerOpContext& context,
                                   const MarkerState& state,
                                   OpReport& report) {
  const Status usable = check_op_keys(context.op, {.span = true, .blend = true});
  if (!usable) return usable.error();
  const Status valid = check_filter(op, state.tracks.rate.hz);
  if (!valid) return valid.error();
  const auto weights = op_weights(timeline_of(state), context.op);
  if (!weights) return weights.error();
  MarkerState out = state;
  MarkerFilter(op, *weights, out).run(state, report);
  touch(out.lineage, weights->frames, context.index);
  return out;
}

}  // namespace marey::edit
