// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/assert.h"
#include "core/pose.h"
#include "recordings/motion/npy_array.h"
#include "recordings/motion/npz.h"

namespace {

using namespace marey;
using namespace marey::recordings;

void check(const NpzMotion& read) {
  const Skeleton& skeleton = read.motion.skeleton;
  MAREY_ASSERT(!skeleton.joints.empty());
  for (const Pose& pose : read.motion.poses) {
    for (const RigidTransform& joint : world_from_joints(skeleton, pose)) {
      MAREY_ASSERT(std::isfinite(glm::dot(joint.translation, joint.translation)));
    }
  }
  MAREY_ASSERT(read.uncertainty.empty() ||
               read.uncertainty.size() == read.motion.poses.size());
  MAREY_ASSERT(read.contacts.bears.size() ==
               read.contacts.names.size() * read.motion.poses.size());
  // A motion that was read can be written and read again.
  const auto bytes =
      npz_bytes(read.motion, {read.uncertainty, read.contacts, read.start_s});
  MAREY_ASSERT(bytes.has_value() && parse_npz(*bytes, "again.npz").has_value());
}

std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i]))
             << (8U * i);
  }
  return value;
}

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 1U) != 0 ? 0xedb88320U ^ (crc >> 1U) : crc >> 1U;
    }
  }
  return ~crc;
}

/// The archive with its checksums corrected, which no mutation hits.
std::string with_checksums(std::string_view archive) {
  std::string corrected(archive);
  for (std::size_t at = corrected.find("PK\x01\x02");
       at != std::string::npos && corrected.size() - at >= 46;
       at = corrected.find("PK\x01\x02", at + 46)) {
    const std::size_t size = number_at(archive, at + 20, 4);
    const std::size_t local = number_at(archive, at + 42, 4);
    if (local > archive.size() || archive.size() - local < 30) continue;
    const std::size_t begin = local + 30 + number_at(archive, local + 26, 2) +
                              number_at(archive, local + 28, 2);
    if (begin > archive.size() || archive.size() - begin < size) continue;
    const std::uint32_t crc = crc32(archive.substr(begin, size));
    for (unsigned i = 0; i < 4; ++i) {
      corrected[at + 16 + i] = static_cast<char>(crc >> (8U * i));
      corrected[local + 14 + i] = corrected[at + 16 + i];
    }
  }
  return corrected;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  (void)npy_array(bytes);
  const Result<NpzMotion> read = parse_npz(with_checksums(bytes), "fuzz.npz");
  if (read) {
    check(*read);
  } else {
    MAREY_ASSERT(!read.error().cause.empty());
  }
  return 0;
}
