// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/dynamics/captured_push.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/jumps/find_jumps.h"
#include "dynamics/push/fit_push.h"
#include "dynamics/push/force_splines.h"
#include <Eigen/Dense>

namespace marey {
namespace {

/// DJ1 above 20 N, from its plates at 2 kHz.
constexpr double kDropJumpTouchdown_s = 1.4925;
constexpr double kDropJumpTakeoff_s = 2.2605;

std::string person_of(const std::string& clip) {
  if (clip.starts_with("DJ")) return "DJ";
  if (clip.starts_with("Rajagopal")) return "Rajagopal";
  if (clip.starts_with("Hamner")) return "Hamner";
  if (clip.starts_with("02_")) return "CMU 02";
  return clip;
}

}  // namespace

std::optional<CapturedPush> captured_push(const JumpClip& clip,
                                          double start_s,
                                          double end_s,
                                          bool from_touchdown) {
  CapturedPush out;
  out.name = clip.name;
  out.person = person_of(clip.name);
  out.kind = clip.kind;
  out.from_touchdown = from_touchdown;
  out.lowest_m = 1e9;
  for (std::size_t i = 0; i < clip.frames(); ++i) {
    const double at_s = static_cast<double>(i) / clip.hz();
    if (at_s < start_s || at_s > end_s) continue;
    const double height_m = clip.track.com_in_world[i].y;
    out.time_s.push_back(at_s - start_s);
    out.height_m.push_back(height_m);
    if (height_m >= out.lowest_m) continue;
    out.lowest_m = height_m;
    out.lowest_at = (at_s - start_s) / (end_s - start_s);
  }
  auto fit = dynamics::fit_push(out.time_s,
                                out.height_m,
                                end_s - start_s,
                                {.from_flight = from_touchdown, .to_flight = true});
  if (!fit) return std::nullopt;
  out.ends = fit->ends;
  out.reference = std::move(fit->reference);
  return out;
}

std::vector<CapturedPush> captured_pushes(const JumpClip& clip) {
  std::vector<CapturedPush> out;
  int number = 0;
  for (const dynamics::Jump& jump : dynamics::find_jumps(clip.track)) {
    double start_s = jump.start.time_s;
    double end_s = jump.takeoff.time_s;
    const bool from_touchdown = jump.start_kind == dynamics::PushStart::kTouchdown;
    if (jump.start_kind == dynamics::PushStart::kClipStart) continue;
    if (clip.kind == "run" && !from_touchdown) continue;
    if (clip.kind == "jump" && jump.rise_m() < 0.1) continue;  // Steps off a box.
    if (clip.name == "DJ1") {
      if (std::abs(end_s - kDropJumpTakeoff_s) > 0.1) continue;
      start_s = kDropJumpTouchdown_s;
      end_s = kDropJumpTakeoff_s;
    }
    auto push = captured_push(clip, start_s, end_s, from_touchdown);
    if (!push) continue;
    if (clip.kind == "run") push->name += " step " + std::to_string(++number);
    out.push_back(*std::move(push));
  }
  return out;
}

HeightError represent_by_splines(const CapturedPush& push, int coefficients) {
  const dynamics::ForceSplines splines(coefficients);
  const double t = push.ends.duration_s;
  const dynamics::PushMoments moments = dynamics::push_moments(push.ends);
  const auto size = static_cast<std::size_t>(coefficients);
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(coefficients + 2, coefficients + 2);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(coefficients + 2);
  std::vector<double> row(size);
  constexpr int kSamples = 2000;
  for (int k = 0; k < kSamples; ++k) {
    const double x = (k + 0.5) / kSamples;
    splines.write_values(x, row);
    const double force = dynamics::reference_force(push.reference, x);
    for (int i = 0; i < coefficients; ++i) {
      right[i] += row[static_cast<std::size_t>(i)] * force / kSamples;
      for (int j = 0; j < coefficients; ++j) {
        system(i, j) += row[static_cast<std::size_t>(i)] *
                        row[static_cast<std::size_t>(j)] / kSamples;
      }
    }
  }
  splines.write_integrals(1.0, row);
  for (int i = 0; i < coefficients; ++i) {
    system(i, coefficients) = system(coefficients, i) = row[static_cast<std::size_t>(i)];
  }
  splines.write_double_integrals(1.0, row);
  for (int i = 0; i < coefficients; ++i) {
    system(i, coefficients + 1) = system(coefficients + 1, i) =
        row[static_cast<std::size_t>(i)];
  }
  right[coefficients] = moments.impulse_m_s / t;
  right[coefficients + 1] = moments.first_moment_m / (t * t);
  const Eigen::VectorXd solved = system.fullPivLu().solve(right);
  return height_error(push, [&](double t_s) {
    splines.write_double_integrals(t_s / t, row);
    double twice = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      twice += solved[static_cast<Eigen::Index>(i)] * row[i];
    }
    return push.ends.start_m + push.ends.start_m_s * t_s + t * t * twice -
           0.5 * push.ends.gravity_m_s2 * t_s * t_s;
  });
}

}  // namespace marey
