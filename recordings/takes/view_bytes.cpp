// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/view_bytes.h"

#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>

namespace marey::recordings {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

template <class T>
void put(std::vector<std::byte>& out, T value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

/// Reads numbers one after the other; after the end of the data, all are zero.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  T get() {
    T value{};
    if (rest_.size() < sizeof value) {
      fail();
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_ = rest_.subspan(sizeof value);
    if constexpr (std::floating_point<T>) {
      if (!std::isfinite(value)) fail();
    }
    return value;
  }
  void fail() {
    failed_ = true;
    rest_ = {};
  }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
  bool failed_ = false;
};

/// Bytes of a tag, and of a view without its tags.
constexpr std::size_t kTagBytes = 4 + 8 * 8 + 8 + 8 + 4;
constexpr std::size_t kViewBytes = 4 + 8 + 4;

TagDetection read_tag(Reader& in) {
  TagDetection tag;
  tag.id = TagId{in.get<std::int32_t>()};
  for (glm::dvec2& corner : tag.corners_px) {
    corner.x = in.get<double>();
    corner.y = in.get<double>();
  }
  tag.sigma_px = in.get<double>();
  tag.decision_margin = in.get<double>();
  tag.hamming = in.get<std::int32_t>();
  if (!(tag.sigma_px > 0.0)) in.fail();
  return tag;
}

}  // namespace

void write_views(std::span<const CameraTags> views, std::vector<std::byte>& out) {
  out.clear();
  put(out, static_cast<std::uint32_t>(views.size()));
  for (const CameraTags& view : views) {
    put(out, static_cast<std::int32_t>(index(view.camera)));
    put(out, std::int64_t{view.time.count()});
    put(out, static_cast<std::uint32_t>(view.tags.size()));
    for (const TagDetection& tag : view.tags) {
      put(out, static_cast<std::int32_t>(number(tag.id)));
      for (const glm::dvec2& corner : tag.corners_px) {
        put(out, corner.x);
        put(out, corner.y);
      }
      put(out, tag.sigma_px);
      put(out, tag.decision_margin);
      put(out, static_cast<std::int32_t>(tag.hamming));
    }
  }
}

std::optional<std::vector<CameraTags>> read_views(std::span<const std::byte> bytes,
                                                  std::size_t cameras) {
  Reader in(bytes);
  std::vector<CameraTags> views;
  const auto count = in.get<std::uint32_t>();
  if (count > in.left() / kViewBytes) return std::nullopt;
  std::int64_t last_camera = -1;
  for (std::uint32_t v = 0; v < count; ++v) {
    CameraTags& view = views.emplace_back();
    const std::int64_t camera = in.get<std::int32_t>();
    if (camera <= last_camera || camera >= static_cast<std::int64_t>(cameras)) in.fail();
    last_camera = camera;
    view.camera = CameraId{static_cast<int>(camera)};
    view.time = Timestamp{in.get<std::int64_t>()};
    const auto tags = in.get<std::uint32_t>();
    if (tags > in.left() / kTagBytes) return std::nullopt;
    for (std::uint32_t t = 0; t < tags; ++t) {
      const TagDetection tag = read_tag(in);
      if (!view.tags.empty() && tag.id <= view.tags.back().id) in.fail();
      view.tags.push_back(tag);
    }
  }
  if (in.failed() || in.left() > 0) return std::nullopt;
  return views;
}

}  // namespace marey::recordings
