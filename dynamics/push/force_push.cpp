// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/force_push.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace marey::dynamics {
namespace {

using Piece = ForcePush::Piece;

double cubic_at(const Piece& piece, double u) {
  const auto& c = piece.cubic_m_s2;
  return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}

/// Second derivative with respect to u.
double bend_at(const Piece& piece, double u) {
  return 2.0 * piece.cubic_m_s2[2] + 6.0 * piece.cubic_m_s2[3] * u;
}

struct PiecePlace {
  std::size_t piece = 0;
  double u = 0.0;
};
PiecePlace piece_of(double x) {
  const double scaled = x * ForcePush::kPieces;
  const int piece = std::clamp(static_cast<int>(scaled), 0, ForcePush::kPieces - 1);
  return {static_cast<std::size_t>(piece), scaled - piece};
}

/// Solves 3 a u^2 + 2 b u + c = 0 for the stationary points of a cubic.
std::array<double, 2> stationary_points(double a, double b, double c) {
  const double root = std::sqrt(std::max(b * b - 3.0 * a * c, 0.0));
  const double larger = -(b + std::copysign(root, b));
  return {a != 0.0 ? larger / (3.0 * a) : -1.0, larger != 0.0 ? c / larger : -1.0};
}

/// Part of a knot interval on which the reference is linear.
struct LinearPart {
  double from_u = 0.0, to_u = 0.0;
  double from_m_s2 = 0.0, to_m_s2 = 0.0;  ///< Force at its ends.
  double reference_slope_m_s2 = 0.0;      ///< Per u.
};

/// Lowers or raises the extremes by the force on `part` of piece `index`.
void include_part(const Piece& piece,
                  std::size_t index,
                  const LinearPart& part,
                  ForcePush::Extremes& out) {
  const auto include = [&](double u, double force) {
    const double x = (static_cast<double>(index) + u) / ForcePush::kPieces;
    if (force < out.min.force_m_s2) out.min = {x, force};
    if (force > out.max.force_m_s2) out.max = {x, force};
  };
  include(part.from_u, part.from_m_s2);
  include(part.to_u, part.to_m_s2);
  const double width = part.to_u - part.from_u;
  // A curve leaves its chord by at most width^2 / 8 times its largest second derivative.
  const double bulge = width * width / 8.0 *
                       std::max(std::abs(bend_at(piece, part.from_u)),
                                std::abs(bend_at(piece, part.to_u)));
  if (std::min(part.from_m_s2, part.to_m_s2) - bulge >= out.min.force_m_s2 &&
      std::max(part.from_m_s2, part.to_m_s2) + bulge <= out.max.force_m_s2) {
    return;
  }
  const auto& c = piece.cubic_m_s2;
  for (const double u : stationary_points(c[3], c[2], c[1] + part.reference_slope_m_s2)) {
    if (u <= part.from_u || u >= part.to_u) continue;
    const double reference = part.from_m_s2 - cubic_at(piece, part.from_u) +
                             part.reference_slope_m_s2 * (u - part.from_u);
    include(u, reference + cubic_at(piece, u));
  }
}

}  // namespace

double ForcePush::force_m_s2(double t_s) const {
  const double x = t_s / ends_.duration_s;
  const auto [piece, u] = piece_of(x);
  return reference_scale_ * reference_force(*reference_, x) + cubic_at(pieces_[piece], u);
}

double ForcePush::velocity_m_s(double t_s) const {
  const double x = t_s / ends_.duration_s;
  const auto [index, u] = piece_of(x);
  const Piece& piece = pieces_[index];
  const auto& c = piece.cubic_m_s2;
  const double inside = u * (c[0] + u * (c[1] / 2.0 + u * (c[2] / 3.0 + u * c[3] / 4.0)));
  const double mean_m_s2 = reference_scale_ * reference_once(*reference_, x) +
                           piece.once_m_s2 + inside / kPieces;
  return ends_.start_m_s + ends_.duration_s * mean_m_s2 - gravity_m_s2_ * t_s;
}

double ForcePush::height_m(double t_s) const {
  const double x = t_s / ends_.duration_s;
  const auto [index, u] = piece_of(x);
  const Piece& piece = pieces_[index];
  const auto& c = piece.cubic_m_s2;
  const double inside =
      u * u * (c[0] / 2.0 + u * (c[1] / 6.0 + u * (c[2] / 12.0 + u * c[3] / 20.0)));
  const double twice_m_s2 = reference_scale_ * reference_twice(*reference_, x) +
                            piece.twice_m_s2 +
                            (u * piece.once_m_s2 + inside / kPieces) / kPieces;
  return ends_.start_m + ends_.start_m_s * t_s +
         ends_.duration_s * ends_.duration_s * twice_m_s2 -
         0.5 * gravity_m_s2_ * t_s * t_s;
}

double ForcePush::largest_correction_m_s2() const {
  double out = 0.0;
  for (const double c : correction_m_s2_) out = std::max(out, std::abs(c));
  return out;
}

ForcePush::Extremes ForcePush::extremes() const {
  const auto& force = reference_->force_m_s2;
  const double first = reference_scale_ * force.front() + pieces_[0].cubic_m_s2[0];
  Extremes out{{0.0, first}, {0.0, first}};
  const auto segments = static_cast<double>(force.size() - 1);
  const double u_per_segment = kPieces / segments;
  std::size_t segment = 0;
  for (std::size_t index = 0; index < pieces_.size(); ++index) {
    const Piece& piece = pieces_[index];
    double u = 0.0;
    while (u < 1.0) {
      const double segment_start_u =
          static_cast<double>(segment) * u_per_segment - static_cast<double>(index);
      const double segment_end_u = segment_start_u + u_per_segment;
      const bool last = segment + 2 == force.size();
      const double to_u = last ? 1.0 : std::min(segment_end_u, 1.0);
      const double slope =
          reference_scale_ * (force[segment + 1] - force[segment]) / u_per_segment;
      const double base = reference_scale_ * force[segment] - slope * segment_start_u;
      include_part(piece,
                   index,
                   {u,
                    to_u,
                    base + slope * u + cubic_at(piece, u),
                    base + slope * to_u + cubic_at(piece, to_u),
                    slope},
                   out);
      if (!last && segment_end_u <= 1.0) ++segment;
      u = to_u;
    }
  }
  return out;
}

}  // namespace marey::dynamics
