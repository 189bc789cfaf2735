// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/pack_frames.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");
static_assert(kFrameBytes == 426);

constexpr std::size_t kFlagBytes = (kUsedRotations * 3 + 7) / 8;

template <class T>
void put_number(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Reads numbers one after the other. Precondition: enough bytes are left.
class NumberReader {
 public:
  explicit NumberReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T get() {
    T value{};
    MAREY_ASSERT(rest_.size() >= sizeof value);
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

/// Place and sign of the component that is left out of a rotation.
struct DroppedComponent {
  unsigned place = 0;
  bool is_negative = false;
};

DroppedComponent put_rotation(std::string& out, std::array<float, 4> q) {
  double squares = 0.0;
  for (const float part : q) squares += static_cast<double>(part) * part;
  // Components of a rotation that is already of unit length stay exact: half a unit of
  // its floats is 6e-8.
  constexpr double kExact = 1.2e-7;
  const double length = std::sqrt(squares);
  MAREY_ASSERT(std::abs(length - 1.0) < 1e-2);
  if (std::abs(length - 1.0) > kExact) {
    for (float& part : q) part = static_cast<float>(part / length);
  }
  DroppedComponent dropped;
  for (unsigned k = 1; k < 4; ++k) {
    if (std::abs(q[k]) > std::abs(q[dropped.place])) dropped.place = k;
  }
  dropped.is_negative = std::signbit(q[dropped.place]);
  for (unsigned k = 0; k < 4; ++k) {
    if (k != dropped.place) put_number(out, q[k]);
  }
  return dropped;
}

/// Returns false if no rotation has these components.
bool get_rotation(NumberReader& in,
                  const DroppedComponent& dropped,
                  std::array<float, 4>& q) {
  double squares = 0.0;
  for (unsigned k = 0; k < 4; ++k) {
    if (k == dropped.place) continue;
    q[k] = in.get<float>();
    squares += static_cast<double>(q[k]) * q[k];
  }
  // The largest of four squares with the sum 1 is at least 1/4.
  constexpr double kMaxSquares = 0.7501;
  if (!(squares <= kMaxSquares)) return false;
  const auto rest = static_cast<float>(std::sqrt(1.0 - squares));
  q[dropped.place] = dropped.is_negative ? -rest : rest;
  return true;
}

std::array<BlendPosture::Rotations BlendPosture::*, 4> rotation_parts() {
  return {&BlendPosture::x, &BlendPosture::y, &BlendPosture::z, &BlendPosture::w};
}

std::array<std::array<float, 4> BlendPosture::*, 5> limb_parts() {
  return {&BlendPosture::fold_rad,
          &BlendPosture::mid_x,
          &BlendPosture::mid_y,
          &BlendPosture::upper_twist_rad,
          &BlendPosture::lower_twist_rad};
}

std::array<float BlendPosture::*, 3> height_parts() {
  return {&BlendPosture::height_legs,
          &BlendPosture::abdomen_share,
          &BlendPosture::torso_share};
}

std::array<float ClipRoot::*, 3> root_parts() {
  return {&ClipRoot::x_legs, &ClipRoot::z_legs, &ClipRoot::heading_rad};
}

void set_flags(std::array<std::uint8_t, kFlagBytes>& flags,
               std::size_t rotation,
               const DroppedComponent& dropped) {
  const unsigned value = dropped.place | (dropped.is_negative ? 4U : 0U);
  for (unsigned bit = 0; bit < 3; ++bit) {
    const std::size_t at = 3 * rotation + bit;
    if ((value >> bit & 1U) != 0) {
      flags[at / 8] = static_cast<std::uint8_t>(flags[at / 8] | 1U << (at % 8));
    }
  }
}

DroppedComponent flags_of(const std::array<std::uint8_t, kFlagBytes>& flags,
                          std::size_t rotation) {
  unsigned value = 0;
  for (unsigned bit = 0; bit < 3; ++bit) {
    const std::size_t at = 3 * rotation + bit;
    if ((flags[at / 8] >> (at % 8) & 1U) != 0) value |= 1U << bit;
  }
  return {value & 3U, (value & 4U) != 0};
}

void pack_frame(std::string& out, const BlendPosture& frame, const ClipRoot& root) {
  std::array<std::uint8_t, kFlagBytes> flags{};
  std::string rotations;
  for (std::size_t r = 0; r < kUsedRotations; ++r) {
    set_flags(flags,
              r,
              put_rotation(rotations, {frame.x[r], frame.y[r], frame.z[r], frame.w[r]}));
  }
  for (const std::uint8_t byte : flags) put_number(out, byte);
  out += rotations;
  for (const auto part : limb_parts()) {
    for (const float value : frame.*part) put_number(out, value);
  }
  for (const auto part : height_parts()) put_number(out, frame.*part);
  for (const auto part : root_parts()) put_number(out, root.*part);
}

/// Returns the number; `is_finite` becomes false if it is not.
float finite_number(NumberReader& in, bool& is_finite) {
  const float value = in.get<float>();
  if (!std::isfinite(value)) is_finite = false;
  return value;
}

bool unpack_frame(NumberReader& in, BlendPosture& frame, ClipRoot& root) {
  std::array<std::uint8_t, kFlagBytes> flags{};
  for (std::uint8_t& byte : flags) byte = in.get<std::uint8_t>();
  std::array<float, 4> q{};
  for (std::size_t r = 0; r < kUsedRotations; ++r) {
    if (!get_rotation(in, flags_of(flags, r), q)) return false;
    for (std::size_t k = 0; k < 4; ++k) (frame.*rotation_parts()[k])[r] = q[k];
  }
  for (std::size_t r = kUsedRotations; r < kPostureRotations; ++r) frame.w[r] = 1.0F;
  bool is_finite = true;
  for (const auto part : limb_parts()) {
    for (float& value : frame.*part) value = finite_number(in, is_finite);
  }
  for (const auto part : height_parts()) frame.*part = finite_number(in, is_finite);
  for (const auto part : root_parts()) root.*part = finite_number(in, is_finite);
  return is_finite;
}

}  // namespace

std::string pack_frames(std::span<const BlendPosture> frames,
                        std::span<const ClipRoot> path) {
  MAREY_ASSERT(frames.size() == path.size());
  std::string out;
  out.reserve(frames.size() * kFrameBytes);
  for (std::size_t i = 0; i < frames.size(); ++i) pack_frame(out, frames[i], path[i]);
  return out;
}

std::optional<UnpackedFrames> unpack_frames(std::string_view bytes) {
  if (bytes.size() % kFrameBytes != 0) return std::nullopt;
  UnpackedFrames out;
  out.frames.resize(bytes.size() / kFrameBytes);
  out.path.resize(out.frames.size());
  NumberReader in(bytes);
  for (std::size_t i = 0; i < out.frames.size(); ++i) {
    if (!unpack_frame(in, out.frames[i], out.path[i])) return std::nullopt;
  }
  return out;
}

std::string pack_contacts(const ClipContacts& contacts) {
  std::string out;
  for (const std::vector<ClipSpan>& part : contacts) {
    put_number(out, static_cast<std::uint32_t>(part.size()));
    for (const ClipSpan& span : part) {
      put_number(out, span.start_s);
      put_number(out, span.end_s);
    }
  }
  return out;
}

std::optional<ClipContacts> unpack_contacts(std::string_view bytes) {
  ClipContacts contacts;
  NumberReader in(bytes);
  for (std::vector<ClipSpan>& part : contacts) {
    if (in.left() < 4) return std::nullopt;
    const std::size_t count = in.get<std::uint32_t>();
    if (count > in.left() / 8) return std::nullopt;
    part.resize(count);
    for (ClipSpan& span : part) {
      span.start_s = in.get<float>();
      span.end_s = in.get<float>();
    }
  }
  if (in.left() > 0) return std::nullopt;
  return contacts;
}

std::string pack_layout(const PostureLayout& layout) {
  std::string out;
  for (const float at : layout.abdomen_at) put_number(out, at);
  for (const float at : layout.torso_at) put_number(out, at);
  for (const float at : layout.neck_at) put_number(out, at);
  return out;
}

std::optional<PostureLayout> unpack_layout(std::string_view bytes) {
  if (bytes.size() != (kAbdomenKnots + kTorsoKnots + kNeckKnots) * 4) return std::nullopt;
  PostureLayout layout;
  NumberReader in(bytes);
  for (float& at : layout.abdomen_at) at = in.get<float>();
  for (float& at : layout.torso_at) at = in.get<float>();
  for (float& at : layout.neck_at) at = in.get<float>();
  return layout;
}

}  // namespace marey::recordings
