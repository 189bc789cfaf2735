// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/assert.h"

namespace marey::live {
namespace {

constexpr std::uint8_t kFrame = 1;
constexpr std::uint8_t kThumbnail = 2;
constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kHasPose = 1;
constexpr std::uint8_t kHasUncertainty = 2;
constexpr std::uint8_t kHasBalance = 4;
constexpr std::uint8_t kHasTracking = 8;
constexpr std::uint8_t kHasZmp = 16;

/// Appends numbers in little-endian order.
class Writer {
 public:
  explicit Writer(std::string& out) : out_(out) {}

  void u8(std::uint8_t value) { out_.push_back(static_cast<char>(value)); }
  void u16(std::size_t value) {
    MAREY_ASSERT(value <= 0xFFFF);
    whole(static_cast<std::uint16_t>(value));
  }
  void u32(std::uint32_t value) { whole(value); }
  void f32(double value) {
    // Converting a double beyond the range of float is undefined behaviour.
    constexpr double kMax = std::numeric_limits<float>::max();
    const double held = std::isnan(value) ? value : std::clamp(value, -kMax, kMax);
    whole(std::bit_cast<std::uint32_t>(static_cast<float>(held)));
  }
  void f64(double value) { whole(std::bit_cast<std::uint64_t>(value)); }
  void point(const glm::dvec3& p) {
    f32(p.x);
    f32(p.y);
    f32(p.z);
  }
  void text(std::string_view bytes) { out_.append(bytes); }

 private:
  template <class T>
  void whole(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      out_.push_back(static_cast<char>(static_cast<unsigned char>(value >> (8 * i))));
    }
  }

  std::string& out_;
};

std::uint8_t code(Source source) {
  switch (source) {
    case Source::kMeasured:
      return 0;
    case Source::kRepaired:
      return 1;
    case Source::kInferred:
      return 2;
  }
  return 2;
}

void write_uncertainty(std::span<const JointUncertainty> uncertainty, Writer& out) {
  for (const JointUncertainty& d : uncertainty) out.f32(d.sigma_m);
  for (const JointUncertainty& d : uncertainty) out.u8(code(d.source));
  // Pad to four bytes, so that a typed array can view the numbers of the next part.
  for (std::size_t i = uncertainty.size(); i % 4 != 0; ++i) out.u8(0);
}

void write_balance(const PageBalance& balance, Writer& out) {
  out.point(balance.centre_of_mass_in_world);
  out.u16(balance.support_xz_m.size());
  out.u16(0);
  for (const glm::dvec2& p : balance.support_xz_m) {
    out.f32(p.x);
    out.f32(p.y);
  }
  if (!balance.zmp_xz_m) return;
  out.f32(balance.zmp_xz_m->x);
  out.f32(balance.zmp_xz_m->y);
}

void write_tracking(const PageTracking& tracking, Writer& out) {
  out.f32(tracking.residual_px.value_or(std::numeric_limits<double>::quiet_NaN()));
  std::uint8_t bears = 0;
  for (std::size_t i = 0; i < tracking.bears.size(); ++i) {
    if (tracking.bears[i]) bears |= static_cast<std::uint8_t>(1U << i);
  }
  out.u8(bears);
  for (int i = 0; i < 3; ++i) out.u8(0);
}

void write_figure(const PageFigure& figure, Writer& out) {
  std::uint8_t flags = 0;
  if (figure.pose != nullptr) flags |= kHasPose;
  if (!figure.uncertainty.empty()) flags |= kHasUncertainty;
  if (figure.balance) flags |= kHasBalance;
  if (figure.balance && figure.balance->zmp_xz_m) flags |= kHasZmp;
  if (figure.tracking) flags |= kHasTracking;
  out.u8(flags);
  out.u8(0);
  out.u16(figure.joints);
  if (figure.pose != nullptr) {
    MAREY_ASSERT(figure.pose->parent_from_joint.size() == figure.joints);
    out.point(figure.pose->root_in_world);
    for (const glm::dquat& q : figure.pose->parent_from_joint) {
      out.f32(q.x);
      out.f32(q.y);
      out.f32(q.z);
      out.f32(q.w);
    }
  }
  if (!figure.uncertainty.empty()) {
    MAREY_ASSERT(figure.uncertainty.size() == figure.joints);
    write_uncertainty(figure.uncertainty, out);
  }
  if (figure.balance) write_balance(*figure.balance, out);
  if (figure.tracking) write_tracking(*figure.tracking, out);
}

}  // namespace

void append_frame(const PageFrame& frame, std::string& out) {
  Writer writer(out);
  writer.u8(kFrame);
  writer.u8(kVersion);
  writer.u16(frame.figures.size());
  writer.u32(frame.frame);
  writer.f64(frame.time_s);
  writer.f64(frame.sent_s);
  for (const PageFigure& figure : frame.figures) write_figure(figure, writer);
}

void append_motion_block_head(std::uint32_t frames,
                              std::uint32_t skeletons,
                              std::string& out) {
  Writer writer(out);
  writer.text("MRMB");
  writer.u32(kVersion);
  writer.u32(frames);
  writer.u32(skeletons);
}

void append_point_block(const MarkerTracks& tracks, std::string& out) {
  constexpr std::size_t kBytesEach = 16;
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  out.reserve(out.size() + kBytesEach * (1 + tracks.samples.size()));
  Writer writer(out);
  writer.text("MRPB");
  writer.u32(kVersion);
  writer.u32(static_cast<std::uint32_t>(tracks.frames()));
  writer.u32(static_cast<std::uint32_t>(tracks.markers()));
  for (const auto& sample : tracks.samples) {
    writer.point(sample ? sample->p_in_world : glm::dvec3(kNowhere));
    writer.u8(code(sample ? sample->source : Source::kInferred));
    for (int i = 0; i < 3; ++i) writer.u8(0);
  }
}

void append_thumbnail(const PageThumbnail& thumbnail, std::string& out) {
  MAREY_ASSERT(thumbnail.width_px >= 0 && thumbnail.height_px >= 0);
  Writer writer(out);
  writer.u8(kThumbnail);
  writer.u8(thumbnail.camera);
  writer.u16(static_cast<std::size_t>(thumbnail.width_px));
  writer.u16(static_cast<std::size_t>(thumbnail.height_px));
  writer.u16(thumbnail.tags.size());
  for (const TagDetection& tag : thumbnail.tags) {
    writer.u32(static_cast<std::uint32_t>(number(tag.id)));
    for (const glm::dvec2& corner_px : tag.corners_px) {
      writer.f32(corner_px.x);
      writer.f32(corner_px.y);
    }
  }
  writer.text(thumbnail.jpeg);
}

}  // namespace marey::live
