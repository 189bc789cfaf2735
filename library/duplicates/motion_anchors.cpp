// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/duplicates/motion_anchors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "library/features/body_features.h"
#include "library/features/level_frame.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr std::array kAnchorPoints = {BodyPoint::kHead,
                                      BodyPoint::kLeftHand,
                                      BodyPoint::kRightHand,
                                      BodyPoint::kLeftAnkle,
                                      BodyPoint::kRightAnkle};
constexpr std::size_t kInstants = 5;
constexpr std::size_t kPointFloats = 16;
static_assert(kInstants * kPointFloats == kAnchorFloats);
// From one instant to the next, in rows.
constexpr double kInstantStep = 2.0;
constexpr int kSmoothRows = 2;
constexpr int kApartRows = 3;
// Rows between anchors where there are no extrema.
constexpr int kFillRows = 5;
// A clip with fewer extrema is searched by its middle rows, too.
constexpr std::size_t kMinExtrema = 2;
// Length of the values of a still body. [L]
constexpr float kMinChange = 0.005F;

using Places = std::array<float, kPointFloats>;

// Positions relative to the hips, (across, up, forward) of each point.
std::vector<Places> places_of(std::span<const float> rows) {
  std::vector<Places> out(rows.size() / kFeatureStride);
  for (std::size_t t = 0; t < out.size(); ++t) {
    const std::span<const float> row = rows.subspan(t * kFeatureStride, kFeatureStride);
    const float hips_y = row[3 * index(BodyPoint::kHips) + 1];
    out[t] = {};
    for (std::size_t k = 0; k < kAnchorPoints.size(); ++k) {
      const std::size_t from = 3 * index(kAnchorPoints[k]);
      out[t][3 * k] = row[from];
      out[t][3 * k + 1] = row[from + 1] - hips_y;
      out[t][3 * k + 2] = row[from + 2];
    }
  }
  return out;
}

// Squared speeds, smoothed.
std::vector<double> energies_of(const std::vector<Places>& places) {
  const auto count = static_cast<int>(places.size());
  std::vector<double> raw(places.size(), 0.0);
  for (int t = 0; t < count; ++t) {
    const auto before = static_cast<std::size_t>(std::max(0, t - 1));
    const auto after = static_cast<std::size_t>(std::min(count - 1, t + 1));
    if (after == before) continue;
    const double rows = static_cast<double>(after - before);
    for (std::size_t c = 0; c < kPointFloats; ++c) {
      const double v = (places[after][c] - places[before][c]) / rows;
      raw[static_cast<std::size_t>(t)] += v * v;
    }
  }
  std::vector<double> out(places.size(), 0.0);
  for (int t = 0; t < count; ++t) {
    double weights = 0.0;
    for (int k = -kSmoothRows; k <= kSmoothRows; ++k) {
      if (t + k < 0 || t + k >= count) continue;
      const double weight = kSmoothRows + 1 - std::abs(k);
      out[static_cast<std::size_t>(t)] += weight * raw[static_cast<std::size_t>(t + k)];
      weights += weight;
    }
    out[static_cast<std::size_t>(t)] /= weights;
  }
  return out;
}

// Rows of the maxima (sign 1) or minima (sign -1), with their fractions.
std::vector<double> extrema_of(const std::vector<double>& energies, double sign) {
  const auto count = static_cast<int>(energies.size());
  const auto at = [&](int t) { return sign * energies[static_cast<std::size_t>(t)]; };
  std::vector<double> out;
  for (int t = 1; t + 1 < count; ++t) {
    bool is_highest = true;
    for (int k = 1; k <= kApartRows && is_highest; ++k) {
      is_highest =
          (t - k < 0 || at(t - k) < at(t)) && (t + k >= count || at(t + k) <= at(t));
    }
    if (!is_highest) continue;
    const double bend = at(t - 1) - 2.0 * at(t) + at(t + 1);
    const double offset = bend < 0.0 ? 0.5 * (at(t - 1) - at(t + 1)) / bend : 0.0;
    out.push_back(t + std::clamp(offset, -0.5, 0.5));
  }
  return out;
}

Places place_at(const std::vector<Places>& places, double row) {
  row = std::clamp(row, 0.0, static_cast<double>(places.size() - 1));
  const auto before = static_cast<std::size_t>(row);
  const std::size_t after = std::min(before + 1, places.size() - 1);
  const auto part = static_cast<float>(row - static_cast<double>(before));
  Places out{};
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = (1.0F - part) * places[before][c] + part * places[after][c];
  }
  return out;
}

// False: nothing moves.
bool describe(const std::vector<Places>& places,
              double at,
              std::array<float, kAnchorFloats>& out) {
  Places mean{};
  for (std::size_t k = 0; k < kInstants; ++k) {
    const Places place =
        place_at(places, at + kInstantStep * (static_cast<double>(k) - 2.0));
    for (std::size_t c = 0; c < kPointFloats; ++c) {
      out[k * kPointFloats + c] = place[c];
      mean[c] += place[c] / static_cast<float>(kInstants);
    }
  }
  float squares = 0.0F;
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] -= mean[c % kPointFloats];
    squares += out[c] * out[c];
  }
  const float length = std::sqrt(squares);
  if (!(length > kMinChange)) return false;
  for (float& value : out) value /= length;
  return true;
}

std::vector<double> extrema_of_speed(const std::vector<Places>& places) {
  const std::vector<double> energies = energies_of(places);
  std::vector<double> times = extrema_of(energies, 1.0);
  const std::vector<double> minima = extrema_of(energies, -1.0);
  times.insert(times.end(), minima.begin(), minima.end());
  std::sort(times.begin(), times.end());
  return times;
}

MotionAnchors described(const std::vector<Places>& places,
                        const std::vector<double>& times) {
  MotionAnchors anchors;
  std::array<float, kAnchorFloats> values{};
  for (const double at : times) {
    if (!describe(places, at, values)) continue;
    anchors.at.push_back(at);
    anchors.values.insert(anchors.values.end(), values.begin(), values.end());
  }
  return anchors;
}

}  // namespace

MotionAnchors find_anchors(std::span<const float> rows) {
  MAREY_ASSERT(rows.size() % kFeatureStride == 0);
  if (rows.empty()) return {};
  const std::vector<Places> places = places_of(rows);
  std::vector<double> times = extrema_of_speed(places);
  const auto last = static_cast<double>(places.size() - 1);
  const std::size_t extrema = times.size();
  for (std::size_t k = 0; k <= extrema; ++k) {
    const double from = k > 0 ? times[k - 1] : 0.0;
    const double to = k < extrema ? times[k] : last;
    if (to - from < 2.0 * kFillRows) continue;
    for (double at = std::ceil(from) + kFillRows; at < to; at += kFillRows) {
      times.push_back(at);
    }
  }
  times.push_back(0.5 * last);
  std::sort(times.begin(), times.end());
  return described(places, times);
}

MotionAnchors find_queries(std::span<const float> rows, std::size_t max_count) {
  MAREY_ASSERT(rows.size() % kFeatureStride == 0);
  if (rows.empty()) return {};
  const std::vector<Places> places = places_of(rows);
  std::vector<double> times = extrema_of_speed(places);
  const double middle = 0.5 * static_cast<double>(places.size() - 1);
  std::sort(times.begin(), times.end(), [&](double a, double b) {
    return std::make_pair(std::abs(a - middle), a) <
           std::make_pair(std::abs(b - middle), b);
  });
  if (times.size() > max_count) times.resize(max_count);
  if (times.size() < kMinExtrema) {
    for (int k = 0; k < kFillRows; ++k) {
      times.push_back(std::floor(middle) + k - kFillRows / 2);
    }
  }
  times.push_back(middle);
  return described(places, times);
}

}  // namespace marey::library
