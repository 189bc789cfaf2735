// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/motion/motion_files.h"
#include "core/base/result.h"
#include "core/character.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::app {

/// A character, and the motion to adapt on its skeleton.
struct AdaptBody {
  Character character;
  retarget::BodyMap map;
  Motion reference;
  retarget::Contacts contacts;  ///< Of the motion's feet, as far as detected.
  double floor_height_m = 0.0;  ///< World Y on which `reference` stands.
  /// Whose mesh the result can be written with.
  BodyLook look;
};

struct AdaptBodyOptions {
  std::filesystem::path motion;     ///< What `source` was read from.
  std::filesystem::path character;  ///< Of a character.toml; empty: the motion's own.
  /// The reference's feet stand still, and the root comes down where they do not reach.
  bool plant_feet = true;
  double raise_m = 0.0;  ///< By how much the floor and all that stands on it.
};

/// Reads the character and puts the motion on its body: retargeted when the body is
/// another's; its own stays where it is, and all of it as it is unless `plant_feet`.
/// Errors (kBadInput), with the file: as read_character_spec(), read_subject(),
/// read_skeleton(), map_body() and make_character() have them.
[[nodiscard]] Result<AdaptBody> make_adapt_body(const Motion& source,
                                                const AdaptBodyOptions& options);

/// The file that a character.toml has its body from; empty: from none, or it cannot be
/// read.
[[nodiscard]] std::filesystem::path body_file_of(const std::filesystem::path& character);

/// Writes a motion of the body: .bvh, or .glb with the look of the character's own file,
/// else of a mannequin when the skeleton is marey's. Whole or not at all.
[[nodiscard]] Status write_adapted(const AdaptBody& body,
                                   const Motion& motion,
                                   const std::filesystem::path& out);

/// Whether write_adapted() can, before any work is done.
[[nodiscard]] Status check_adapted_out(const AdaptBody& body,
                                       const std::filesystem::path& out);

}  // namespace marey::app
