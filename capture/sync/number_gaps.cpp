// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/sync/number_gaps.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

namespace marey::capture {
namespace {

constexpr std::size_t kMinImages = 10;
constexpr double kAlikeShare = 0.9;  // Share of the steps; time stamps jitter.

struct Numbered {
  std::string prefix;
  std::int64_t number = 0;
};

/// Splits a name before its last number; returns nullopt if it has none, or one of 19
/// digits.
std::optional<Numbered> numbered(const std::filesystem::path& image) {
  const std::string stem = image.stem().string();
  const auto last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  const auto before = stem.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  Numbered out{stem.substr(0, first), 0};
  const char* end = stem.data() + last + 1;
  const auto read = std::from_chars(stem.data() + first, end, out.number);
  if (read.ec != std::errc{} || read.ptr != end) return std::nullopt;
  return out;
}

}  // namespace

std::optional<NumberGap> find_number_gap(std::span<const std::filesystem::path> images) {
  if (images.size() < kMinImages) return std::nullopt;
  std::vector<std::int64_t> numbers;
  std::string prefix;
  for (const std::filesystem::path& image : images) {
    auto one = numbered(image);
    if (!one || (!numbers.empty() && one->prefix != prefix)) return std::nullopt;
    prefix = std::move(one->prefix);
    numbers.push_back(one->number);
  }
  std::map<std::int64_t, std::size_t> steps;
  for (std::size_t i = 1; i < numbers.size(); ++i) ++steps[numbers[i] - numbers[i - 1]];
  const auto usual =
      std::max_element(steps.begin(), steps.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      });
  const std::int64_t step = usual->first;
  const auto all = static_cast<double>(numbers.size() - 1);
  if (step < 1 || static_cast<double>(usual->second) < kAlikeShare * all) {
    return std::nullopt;
  }
  std::optional<NumberGap> gap;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const std::int64_t here = numbers[i] - numbers[i - 1];
    if (here == step) continue;
    if (here < step || here % step != 0) return std::nullopt;
    if (gap) {
      ++gap->gaps;
      continue;
    }
    gap = NumberGap{images[i - 1].filename().string(),
                    images[i].filename().string(),
                    static_cast<int>(here / step - 1)};
  }
  return gap;
}

}  // namespace marey::capture
