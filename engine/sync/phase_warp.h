// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/time_warp.h"

namespace marey::engine {

/// Minimum and maximum rate of a warp: time never stands still.
inline constexpr double kMinWarpRate = 0.25;
inline constexpr double kMaxWarpRate = 4.0;

/// Time of a clip over the time of the engine: monotone, with continuous rate and
/// acceleration, through given knots, and replanned while it runs. Each interval is a
/// quintic. At knots of a plan the acceleration is 0 and the rate the harmonic mean of
/// the mean rates on both sides; a replan starts with the value, rate and acceleration of
/// the old plan `keep_s` later. Before the first and beyond the last knot the rate
/// continues. Fixed size: no function allocates.
class PhaseWarp {
 public:
  /// A warp with this constant rate, at `source_s` at time `now_s`.
  /// Precondition: rate in [kMinWarpRate, kMaxWarpRate].
  void start(double now_s, double source_s, double rate);

  /// Follows these knots from `now_s + keep_s` on; before that it stays as it is. Knots
  /// that are earlier than that are left out. Knots are met exactly where the rate
  /// between kMinWarpRate and kMaxWarpRate permits; otherwise the nearest permitted time
  /// is met (false is returned). First knots that cannot be met, or less than 0.04 s
  /// ahead, are passed over for a later one (false). After the last knot the rate is
  /// `end_rate`. At most kMaxPieces pieces: a replan that finds no room for its first
  /// knot changes nothing, and knots beyond the room are left out (false).
  /// Precondition: started; times and sources of knots ascend strictly.
  bool replan(double now_s,
              std::span<const WarpKnot> knots,
              double end_rate,
              double keep_s = 0.1);

  [[nodiscard]] double source_s(double time_s) const;
  [[nodiscard]] double rate(double time_s) const;
  [[nodiscard]] double acceleration(double time_s) const;
  /// Time after which the rate is constant. [s]
  [[nodiscard]] double end_s() const;

  /// Number of polynomials before the end, and the start of each. [s]
  [[nodiscard]] std::size_t piece_count() const { return count_; }
  [[nodiscard]] double piece_start_s(std::size_t i) const { return pieces_[i].start_s; }

 private:
  struct Piece {
    double start_s = 0.0;
    double length_s = 0.0;
    std::array<double, 6> c{};  // Source time over x in [0, 1].
  };
  static constexpr std::size_t kMaxPieces = 16;
  /// Maximum number of pieces to one knot: an ease, a ramp, a constant rate, a ramp.
  static constexpr std::size_t kNewPieces = 4;
  struct Course;
  /// Drops all pieces outside a span of time. Returns their number.
  std::size_t keep_until(double now_s, double until_s);
  /// Adds the pieces to a knot, or to the nearest time that is permitted.
  static bool follow(Course& course, const WarpKnot& knot, double slope_there);
  [[nodiscard]] const Piece* piece_at(double time_s) const;
  std::array<Piece, kMaxPieces> pieces_{};
  std::size_t count_ = 0;
  double end_s_ = 0.0;
  double end_source_s_ = 0.0;
  double end_rate_ = 1.0;
};

}  // namespace marey::engine
