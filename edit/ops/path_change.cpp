// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/path_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/base/format_text.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

constexpr double kMinStretch = 0.7;
constexpr double kMaxStretch = 1.3;

/// Strength of the change between two frames: 1, with fades at the ends of a span that
/// lie within the motion.
struct ChangeProfile {
  std::vector<double> strength;  ///< One per interval of the span.
  double mean = 1.0;             ///< Over the way.
  double way_m = 0.0;
};

ChangeProfile profile_of(const TravelPath& old, const FrameRange& span) {
  constexpr double kFade = 0.25;
  const int last_frame = static_cast<int>(old.way_m.size()) - 1;
  const double start = old.way_m[static_cast<std::size_t>(span.first)];
  ChangeProfile out;
  out.way_m = old.way_m[static_cast<std::size_t>(span.last)] - start;
  double sum = 0.0;
  for (int frame = span.first; frame < span.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const double step = old.way_m[t + 1] - old.way_m[t];
    const double share = (old.way_m[t] + 0.5 * step - start) / out.way_m;
    double strength = 1.0;
    if (span.first > 0) strength *= smooth_step(share / kFade);
    if (span.last < last_frame) strength *= smooth_step((1.0 - share) / kFade);
    out.strength.push_back(strength);
    sum += strength * step;
  }
  out.mean = sum / out.way_m;
  return out;
}

/// The spline through the points of a path, by its arc length.
class PointCurve {
 public:
  PointCurve(std::span<const glm::dvec2> points, std::optional<double> start_heading)
      : chords_m_(chords_of(points)),
        curve_(through(points, start_heading)),
        by_way_(measure(curve_)) {}

  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] glm::dvec2 at(double way_m) const {
    const double u = by_way_.at(way_m);
    return {curve_[0].at(u), curve_[1].at(u)};
  }
  [[nodiscard]] double heading_rad(double way_m) const {
    const double u = by_way_.at(way_m);
    return std::atan2(curve_[0].slope_at(u), curve_[1].slope_at(u));
  }

 private:
  using Curve = std::array<CubicSpline, 2>;

  static double chords_of(std::span<const glm::dvec2> points) {
    double sum = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      sum += glm::distance(points[i], points[i - 1]);
    }
    return sum;
  }

  static Curve through(std::span<const glm::dvec2> points,
                       std::optional<double> start_heading) {
    std::array<std::vector<double>, 3> columns;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double step = i == 0 ? 0.0 : glm::distance(points[i], points[i - 1]);
      columns[0].push_back(i == 0 ? 0.0 : columns[0].back() + step);
      columns[1].push_back(points[i].x);
      columns[2].push_back(points[i].y);
    }
    std::optional<double> slope_x;
    std::optional<double> slope_z;
    if (start_heading) {
      slope_x = direction_of(*start_heading).x;
      slope_z = direction_of(*start_heading).y;
    }
    return {CubicSpline(columns[0], columns[1], slope_x),
            CubicSpline(columns[0], columns[2], slope_z)};
  }

  CubicSpline measure(const Curve& curve) {
    // The error of a chord falls with the square of its length.
    constexpr int kSamples = 2000;
    std::vector<double> way{0.0};
    std::vector<double> at{0.0};
    glm::dvec2 last{curve[0].at(0.0), curve[1].at(0.0)};
    for (int k = 1; k <= kSamples; ++k) {
      const double u = chords_m_ * k / kSamples;
      const glm::dvec2 p{curve[0].at(u), curve[1].at(u)};
      way.push_back(way.back() + std::max(glm::distance(p, last), 1e-12));
      at.push_back(u);
      last = p;
    }
    length_m_ = way.back();
    return CubicSpline(way, at);
  }

  double chords_m_ = 0.0;
  double length_m_ = 0.0;
  Curve curve_;
  CubicSpline by_way_;
};

std::string metres(double value_m) {
  return format_text("%.2f m", value_m);
}

/// Returns the change of speed at full strength for a path of another length.
Result<double> stretch_for(double length_m, const ChangeProfile& profile) {
  const double stretch = (length_m / profile.way_m - 1.0) / profile.mean;
  constexpr double kRounding = 1e-9;
  if (stretch >= kMinStretch - 1.0 - kRounding &&
      stretch <= kMaxStretch - 1.0 + kRounding) {
    return stretch;
  }
  const auto limit_m = [&](double factor) {
    return metres(profile.way_m * (1.0 + (factor - 1.0) * profile.mean));
  };
  return bad_input("",
                   "the new path is " + metres(length_m) + " long; the steps of " +
                       metres(profile.way_m) + " reach " + limit_m(kMinStretch) + " to " +
                       limit_m(kMaxStretch),
                   "change the length of the path, or the number of steps by cut or "
                   "cyclify first");
}

/// Continues the path rigidly after the span.
void follow(const TravelPath& old, const FrameRange& span, NewPath& out) {
  const auto last = static_cast<std::size_t>(span.last);
  for (std::size_t t = last + 1; t < old.origin_m.size(); ++t) {
    out.turn_rad[t] = out.turn_rad[last];
    out.origin_m[t] = out.origin_m[last] +
                      turned(old.origin_m[t] - old.origin_m[last], out.turn_rad[last]);
  }
}

Result<NewPath> bent_path(const PathOp& op,
                          const TravelPath& old,
                          const FrameRange& span) {
  const ChangeProfile profile = profile_of(old, span);
  const auto stretch = stretch_for(op.length * profile.way_m, profile);
  if (!stretch) return stretch.error();
  NewPath out{old.origin_m, std::vector<double>(old.origin_m.size(), 0.0), 0.0};
  const auto first = static_cast<std::size_t>(span.first);
  double bent_rad = 0.0;
  for (std::size_t k = 0; k < profile.strength.size(); ++k) {
    const std::size_t t = first + k;
    const double share =
        profile.strength[k] * (old.way_m[t + 1] - old.way_m[t]) / profile.way_m;
    bent_rad += op.turn_rad * share / profile.mean;
    out.turn_rad[t + 1] = bent_rad;
    if (op.straight)
      out.turn_rad[t + 1] -= old.heading_rad[t + 1] - old.heading_rad[first];
    const double middle_rad = 0.5 * (out.turn_rad[t] + out.turn_rad[t + 1]);
    out.origin_m[t + 1] =
        out.origin_m[t] + (1.0 + *stretch * profile.strength[k]) *
                              turned(old.origin_m[t + 1] - old.origin_m[t], middle_rad);
  }
  out.length_m = op.length * profile.way_m;
  return out;
}

Result<NewPath> drawn_path(std::vector<glm::dvec2> points,
                           const TravelPath& old,
                           const FrameRange& span) {
  const auto first = static_cast<std::size_t>(span.first);
  const glm::dvec2 start = old.origin_m[first];
  constexpr double kAtStart_m = 0.01;
  const bool starts_inside = span.first > 0;
  if (points.size() < 2 ||
      (starts_inside && glm::distance(points.front(), start) > kAtStart_m)) {
    points.insert(points.begin(), start);
  } else if (starts_inside) {
    points.front() = start;
  }
  const PointCurve curve(
      points, starts_inside ? std::optional(old.heading_rad[first]) : std::nullopt);
  const ChangeProfile profile = profile_of(old, span);
  const auto stretch = stretch_for(curve.length_m(), profile);
  if (!stretch) return stretch.error();
  NewPath out{old.origin_m, std::vector<double>(old.origin_m.size(), 0.0), 0.0};
  double way_m = 0.0;
  for (std::size_t k = 0; k <= profile.strength.size(); ++k) {
    const std::size_t t = first + k;
    if (k > 0) {
      way_m +=
          (1.0 + *stretch * profile.strength[k - 1]) * (old.way_m[t] - old.way_m[t - 1]);
    }
    constexpr double kTwoPi = 2.0 * std::numbers::pi;
    const double turn_rad = curve.heading_rad(way_m) - old.heading_rad[t];
    const double near_rad = k == 0 ? 0.0 : out.turn_rad[t - 1];
    out.turn_rad[t] = turn_rad + kTwoPi * std::round((near_rad - turn_rad) / kTwoPi);
    out.origin_m[t] = curve.at(way_m);
  }
  out.length_m = curve.length_m();
  return out;
}

std::vector<double> column(std::span<const glm::dvec2> points, int axis) {
  std::vector<double> out;
  out.reserve(points.size());
  for (const glm::dvec2& p : points) out.push_back(p[axis]);
  return out;
}

std::vector<double> frame_numbers(std::size_t count) {
  std::vector<double> out(count);
  for (std::size_t t = 0; t < count; ++t) out[t] = static_cast<double>(t);
  return out;
}

/// Rises from 0 to `rise` over [0, 1]: at rest at the start, with speed `speed` at the
/// end, without acceleration at both.
double leave_rest(double x, double rise, double speed) {
  const double x3 = x * x * x;
  return x3 *
         (rise * (10.0 + x * (6.0 * x - 15.0)) + speed * (-4.0 + x * (7.0 - 3.0 * x)));
}

/// A stance and the instant that moves it.
struct MovedStance {
  double first = 0.0;
  double last = 0.0;
  double instant = 0.0;
};

/// Fills the frames between two stances.
void fill_swing(const MovedStance& a,
                const MovedStance& b,
                double fade_frames,
                std::vector<double>& out) {
  const double gap = b.first - a.last;
  const int from = std::max(0, static_cast<int>(std::floor(a.last)) + 1);
  const int to =
      std::min(static_cast<int>(out.size()), static_cast<int>(std::ceil(b.first)));
  for (int frame = from; frame < to; ++frame) {
    const double since = frame - a.last;
    const double until = b.first - frame;
    double& instant = out[static_cast<std::size_t>(frame)];
    if (gap <= 2.0 * fade_frames) {
      instant = a.instant + (b.instant - a.instant) * smooth_step(since / gap);
    } else if (since < fade_frames) {
      instant =
          a.instant +
          leave_rest(since / fade_frames, a.last + fade_frames - a.instant, fade_frames);
    } else if (until < fade_frames) {
      instant =
          b.instant -
          leave_rest(until / fade_frames, b.instant - b.first + fade_frames, fade_frames);
    } else {
      instant = frame;
    }
  }
}

}  // namespace

Result<NewPath> make_new_path(const PathOp& op,
                              const TravelPath& old,
                              const FrameRange& span) {
  auto out = op.points_xz_m.empty() ? bent_path(op, old, span)
                                    : drawn_path(op.points_xz_m, old, span);
  if (out) follow(old, span, *out);
  return out;
}

PathChange::PathChange(const TravelPath& old, const NewPath& made)
    : old_x_(frame_numbers(old.origin_m.size()), column(old.origin_m, 0)),
      old_z_(frame_numbers(old.origin_m.size()), column(old.origin_m, 1)),
      new_x_(frame_numbers(made.origin_m.size()), column(made.origin_m, 0)),
      new_z_(frame_numbers(made.origin_m.size()), column(made.origin_m, 1)),
      turn_(frame_numbers(made.turn_rad.size()), made.turn_rad) {
  MAREY_ASSERT(old.origin_m.size() == made.origin_m.size());
}

RigidTransform PathChange::moved_from_old(double frame) const {
  const double turn_rad = turn_.at(frame);
  const glm::dvec2 shift = glm::dvec2(new_x_.at(frame), new_z_.at(frame)) -
                           turned({old_x_.at(frame), old_z_.at(frame)}, turn_rad);
  return {glm::angleAxis(turn_rad, glm::dvec3(0, 1, 0)), {shift.x, 0.0, shift.y}};
}

std::vector<double> foot_instants(std::span<const FrameRange> stances,
                                  int frame_count,
                                  const FrameRange& span,
                                  double hz) {
  std::vector<double> out = frame_numbers(static_cast<std::size_t>(frame_count));
  if (stances.empty()) return out;
  // Time in which a foot that lands late, or not at all, joins the body's own change.
  constexpr double kFade_s = 0.4;
  const double fade_frames = kFade_s * hz;
  std::vector<MovedStance> moved;
  for (const FrameRange& stance : stances) {
    double instant = 0.5 * (stance.first + stance.last);
    if (stance.first < span.first) instant = std::min<double>(instant, span.first);
    if (stance.last > span.last) instant = std::max<double>(instant, span.last);
    moved.push_back(
        {static_cast<double>(stance.first), static_cast<double>(stance.last), instant});
    std::fill(out.begin() + stance.first, out.begin() + stance.last + 1, instant);
  }
  for (std::size_t i = 1; i < moved.size(); ++i) {
    fill_swing(moved[i - 1], moved[i], fade_frames, out);
  }
  // Beyond both ends the foot swings as between its stances, if it has two.
  const MovedStance& first = moved.front();
  const MovedStance& last = moved.back();
  double swing = fade_frames;
  double half_stance = 0.5 * fade_frames;
  if (moved.size() > 1) {
    swing = std::min(moved[1].first - first.last, 2.0 * fade_frames);
    half_stance = 0.5 * (first.last - first.first);
  }
  const double before = first.first - swing;
  fill_swing({before, before, before - half_stance}, first, fade_frames, out);
  if (moved.size() > 1) {
    swing = std::min(last.first - moved[moved.size() - 2].last, 2.0 * fade_frames);
    half_stance = 0.5 * (last.last - last.first);
  }
  const double after = last.last + swing;
  fill_swing(last, {after, after, after + half_stance}, fade_frames, out);
  if (span.first > 0) {
    for (int frame = 0; frame <= span.first; ++frame) {
      double& instant = out[static_cast<std::size_t>(frame)];
      instant = std::min<double>(instant, span.first);
    }
  }
  for (int frame = span.last; frame < frame_count && span.last < frame_count - 1;
       ++frame) {
    double& instant = out[static_cast<std::size_t>(frame)];
    instant = std::max<double>(instant, span.last);
  }
  return out;
}

}  // namespace marey::edit
