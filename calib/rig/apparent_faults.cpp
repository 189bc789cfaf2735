// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/apparent_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "calib/bundle/rig_normal.h"

namespace marey::calib {
namespace {

constexpr int kWindows = 12;  ///< Windows of the waved trial; the floor is one more.
constexpr int kFine = 8;      ///< Windows within two coarse ones.
// A second camera whose move explains this share of the first one's gain is listed as an
// alternative.
constexpr double kAlternativeShare = 0.8;
// Extra gain, in squared sigmas, that a move from some frame on needs over a move of the
// whole recording. By chance, the best of a dozen starts with six unknowns each gained up
// to 15 more in 16 simulated recordings, for moves of up to 1.5 px shortly before the
// end.
constexpr double kMinStartGain = 30.0;

/// Each unknown of a hypothesis is a sum of columns.
using Hypothesis = std::vector<std::vector<int>>;

struct Verdict {
  Eigen::VectorXd step;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd base_step;  ///< Resulting step of the base.
  double gain = 0.0;
};

/// Normal equations whose base is eliminated once for all hypotheses.
class Tester {
 public:
  Tester(RigNormal normal, int base) : normal_(std::move(normal)), base_(base) {
    const Eigen::MatrixXd information = normal_.information.topLeftCorner(base, base);
    scale_ = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    factor_.compute(scale_.asDiagonal() * information * scale_.asDiagonal());
    const Eigen::Index rest = normal_.information.cols() - base;
    solved_ = solve(normal_.information.topRightCorner(base, rest));
    solved_right_ = solve(normal_.right.head(base));
    const Eigen::MatrixXd mixed = normal_.information.bottomLeftCorner(rest, base);
    information_ = normal_.information.bottomRightCorner(rest, rest) - mixed * solved_;
    right_ = normal_.right.tail(rest) - mixed * solved_right_;
  }

  [[nodiscard]] bool ok() const { return factor_.info() == Eigen::Success; }

  [[nodiscard]] std::optional<Verdict> test(const Hypothesis& hypothesis) const {
    const auto size = static_cast<Eigen::Index>(hypothesis.size());
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      for (const int a : hypothesis[static_cast<std::size_t>(i)]) {
        right[i] += right_[a - base_];
        for (Eigen::Index k = 0; k < size; ++k) {
          for (const int b : hypothesis[static_cast<std::size_t>(k)]) {
            information(i, k) += information_(a - base_, b - base_);
          }
        }
      }
    }
    const Eigen::VectorXd scale =
        information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> factor(
        Eigen::MatrixXd(scale.asDiagonal() * information * scale.asDiagonal()));
    if (factor.info() != Eigen::Success) return std::nullopt;
    Verdict out;
    out.covariance =
        scale.asDiagonal() *
        Eigen::MatrixXd(factor.solve(Eigen::MatrixXd::Identity(size, size))) *
        scale.asDiagonal();
    out.step = out.covariance * right;
    out.gain = out.step.dot(right);
    out.base_step = Eigen::VectorXd::Zero(base_);
    for (Eigen::Index i = 0; i < size; ++i) {
      for (const int a : hypothesis[static_cast<std::size_t>(i)]) {
        out.base_step -= solved_.col(a - base_) * out.step[i];
      }
    }
    return out;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& of) const {
    return scale_.asDiagonal() * Eigen::MatrixXd(factor_.solve(scale_.asDiagonal() * of));
  }

  RigNormal normal_;
  int base_;
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd solved_;
  Eigen::VectorXd solved_right_;
  Eigen::MatrixXd information_;  ///< For the hypotheses' columns, the base eliminated.
  Eigen::VectorXd right_;
};

/// Returns the model with at most a few thousand sightings, in evenly selected frames:
/// more add little information. Keeps all poses of the targets.
RigModel thinned(const RigModel& model) {
  constexpr std::size_t kMax = 12000;
  const auto every = static_cast<int>(1 + model.sightings.size() / kMax);
  RigModel out = model;
  if (every == 1) return out;
  std::erase_if(out.sightings, [&](const Sighting& s) {
    return !model.targets[s.target].stays && s.frame % every != 0;
  });
  return out;
}

/// Frames of the waved trial.
struct Span {
  int first = std::numeric_limits<int>::max();
  int last = std::numeric_limits<int>::min();
};

Span frames_of(const RigModel& model) {
  Span span;
  for (const Sighting& s : model.sightings) {
    if (model.targets[s.target].stays || s.frame == kFloorInstant) continue;
    span.first = std::min(span.first, s.frame);
    span.last = std::max(span.last, s.frame);
  }
  return span;
}

/// Windows of equal length between two frames; one more before and one after.
struct Windows {
  int first = 0;  ///< First frame.
  int last = 0;
  int count = 0;  ///< Number of windows between the two frames.
  bool has_ends = false;

  [[nodiscard]] int floor() const { return count + (has_ends ? 2 : 0); }
  [[nodiscard]] int all() const { return floor() + 1; }
  [[nodiscard]] int of(const RigModel& model, const Sighting& s) const {
    if (s.frame == kFloorInstant) return s.target == 0 ? floor() : -1;
    if (model.targets[s.target].stays) return -1;
    const int shift = has_ends ? 1 : 0;
    if (s.frame < first) return 0;
    if (s.frame > last) return count + 1;
    const double share = (s.frame - first) / static_cast<double>(last - first + 1);
    return shift + std::min(count - 1, static_cast<int>(share * count));
  }
  /// Returns the first frame of a window.
  [[nodiscard]] int frame(int window) const {
    const int shift = has_ends ? 1 : 0;
    const double share = (window - shift) / static_cast<double>(count);
    return first + static_cast<int>(std::ceil(share * (last - first + 1)));
  }
};

/// A camera's move from a window on.
struct Candidate {
  std::size_t camera = 0;
  int from = 0;
  bool with_floor = false;  ///< The floor trial is after the move; otherwise before.
  Verdict verdict;
};

Hypothesis move_of(const RigColumns& columns,
                   const Windows& windows,
                   std::size_t camera,
                   int from,
                   bool with_floor) {
  Hypothesis out(6);
  for (int w = from; w < windows.all(); ++w) {
    if (w == windows.floor() && !with_floor) continue;
    for (int i = 0; i < 6; ++i) {
      out[static_cast<std::size_t>(i)].push_back(columns.window(camera, w) + i);
    }
  }
  return out;
}

/// Returns the best move of each camera.
std::vector<Candidate> best_moves(const RigModel& model,
                                  const RefineOptions& refine,
                                  double rate_hz,
                                  const Windows& windows,
                                  MoveStart start) {
  const RigColumns columns(model, refine, windows.all());
  RigRowOptions options;
  options.rate_hz = rate_hz;
  options.window_of = [&](const Sighting& s) { return windows.of(model, s); };
  auto normal = rig_normal(model, columns, refine, options);
  if (!normal) return {};
  const Tester tester(std::move(*normal), columns.base());
  if (!tester.ok()) return {};
  std::vector<bool> sees_floor(model.cameras.size(), false);
  for (const Sighting& s : model.sightings) {
    if (windows.of(model, s) == windows.floor()) sees_floor[s.camera] = true;
  }
  std::vector<Candidate> out;
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    std::optional<Candidate> whole;
    std::optional<Candidate> later;
    const auto consider = [&](int from, bool with_floor, std::optional<Candidate>& best) {
      auto verdict = tester.test(move_of(columns, windows, c, from, with_floor));
      if (!verdict || (best && verdict->gain <= best->verdict.gain)) return;
      best = Candidate{c, from, with_floor, std::move(*verdict)};
    };
    const auto consider_frames = [&](int from, std::optional<Candidate>& best) {
      consider(from, false, best);
      if (sees_floor[c]) consider(from, true, best);
    };
    if (start == MoveStart::kAnywhere) consider_frames(0, whole);
    for (int from = 1; from < windows.floor(); ++from) consider_frames(from, later);
    if (sees_floor[c]) consider(windows.floor(), true, later);
    const bool is_later =
        later && (!whole || later->verdict.gain > whole->verdict.gain + kMinStartGain);
    auto& best = is_later ? later : whole;
    if (best) out.push_back(std::move(*best));
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return a.verdict.gain > b.verdict.gain;
  });
  return out;
}

double moved_px(const RigModel& model,
                const RefineOptions& refine,
                const Windows& windows,
                const Candidate& move) {
  const RigColumns columns(model, refine, windows.all());
  RigRowOptions options;
  options.window_of = [&](const Sighting& s) {
    return s.camera == move.camera ? windows.of(model, s) : -1;
  };
  double sum = 0.0;
  double count = 0.0;
  const auto by_camera = pixels_by_pose(model, columns, refine, options);
  for (const PixelsByPose& pixels : by_camera[move.camera]) {
    if (pixels.isZero()) continue;
    sum += move.verdict.step.dot(pixels * move.verdict.step);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace

std::optional<ApparentLineDelays> apparent_line_delays(const RigModel& whole,
                                                       const RefineOptions& refine,
                                                       double rate_hz) {
  if (refine.line_delays || !(rate_hz > 0.0)) return std::nullopt;
  const RigModel model = thinned(whole);
  const RigColumns columns(model, refine, 0);
  auto normal = rig_normal(model, columns, refine, {rate_hz, {}});
  if (!normal) return std::nullopt;
  const Tester tester(std::move(*normal), columns.base());
  if (!tester.ok()) return std::nullopt;
  const std::size_t cameras = model.cameras.size();
  Hypothesis clocks;
  for (std::size_t c = 1; c < cameras; ++c) {
    if (columns.offset(c) >= columns.base()) clocks.push_back({columns.offset(c)});
  }
  const auto without =
      clocks.empty() ? Verdict{} : tester.test(clocks).value_or(Verdict{});
  Hypothesis all;
  for (std::size_t c = 0; c < cameras; ++c) all.push_back({columns.line_delay(c)});
  all.insert(all.end(), clocks.begin(), clocks.end());
  const auto found = tester.test(all);
  if (!found) return std::nullopt;
  ApparentLineDelays out;
  for (std::size_t c = 0; c < cameras; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    out.delay_s.push_back(found->step[i]);
    out.sigma_s.push_back(std::sqrt(found->covariance(i, i)));
    const int pose = columns.pose(c);
    out.shift_m.push_back(pose < 0 ? 0.0 : found->base_step.segment<3>(pose + 3).norm());
  }
  out.gain = found->gain - without.gain;
  return out;
}

std::optional<ApparentMove> apparent_move(const RigModel& whole,
                                          const RefineOptions& refine,
                                          double rate_hz,
                                          MoveStart start) {
  const RigModel model = thinned(whole);
  const Span span = frames_of(model);
  if (span.first >= span.last) return std::nullopt;
  Windows windows{span.first, span.last, kWindows, false};
  auto moves = best_moves(model, refine, rate_hz, windows, start);
  if (moves.empty()) return std::nullopt;
  ApparentMove out;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].verdict.gain > kAlternativeShare * moves[0].verdict.gain) {
      out.alternatives.push_back(CameraId{static_cast<int>(moves[i].camera)});
    }
  }
  // Repeats the search with finer windows around the best one.
  if (moves[0].from > 0 && moves[0].from < windows.floor()) {
    const Windows fine{windows.frame(moves[0].from - 1),
                       moves[0].from + 1 < windows.floor()
                           ? windows.frame(moves[0].from + 1) - 1
                           : span.last,
                       kFine,
                       true};
    if (fine.last - fine.first >= kFine) {
      for (Candidate& finer : best_moves(model, refine, rate_hz, fine, start)) {
        const bool is_same = finer.camera == moves[0].camera &&
                             finer.from < fine.floor() &&
                             finer.verdict.gain > moves[0].verdict.gain;
        if (!is_same) continue;
        moves[0] = std::move(finer);
        windows = fine;
        break;
      }
    }
  }
  const Candidate& best = moves[0];
  out.camera = CameraId{static_cast<int>(best.camera)};
  if (best.from > 0 && best.from < windows.floor())
    out.from_frame = windows.frame(best.from);
  out.turn_rad = best.verdict.step.head<3>().norm();
  out.shift_m = best.verdict.step.tail<3>().norm();
  out.moved_px = moved_px(model, refine, windows, best);
  const RigColumns columns(model, refine, windows.all());
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    if (columns.pose(c) < 0) continue;
    out.rig_shift_m = std::max(
        out.rig_shift_m, best.verdict.base_step.segment<3>(columns.pose(c) + 3).norm());
  }
  out.gain = best.verdict.gain;
  return out;
}

}  // namespace marey::calib
