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
#include "recordings/text/zip_store.h"

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
  // What was read can be written and read again.
  const auto bytes =
      npz_bytes(read.motion, {read.uncertainty, read.contacts, read.start_s});
  MAREY_ASSERT(bytes.has_value() && parse_npz(*bytes, "again.npz").has_value());
}

/// The archive with its checksums corrected, which no mutation hits.
std::string with_checksums(std::string_view archive) {
  std::string corrected(archive);
  const auto entries = zip_entries(archive);
  if (!entries) return corrected;
  std::size_t at = corrected.find("PK\x01\x02");
  for (const ZipEntry& entry : *entries) {
    if (at == std::string::npos || corrected.size() - at < 46) break;
    const std::uint32_t crc = crc32(entry.bytes);
    for (unsigned i = 0; i < 4; ++i) {
      corrected[at + 16 + i] = static_cast<char>(crc >> (8U * i));
    }
    at = corrected.find("PK\x01\x02", at + 46);
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
