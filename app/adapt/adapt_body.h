// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/motion/motion_files.h"
#include "core/base/result.h"
#include "core/character.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// A character and the motion to adapt, on the character's skeleton.
struct AdaptBody {
  Character character;
  retarget::BodyMap map;
  Motion reference;
  Contacts contacts;            ///< Detected contacts of the motion's feet.
  double floor_height_m = 0.0;  ///< World Y of the floor of `reference`.
  /// Mesh with which the result can be written.
  BodyLook look;
};

struct AdaptBodyOptions {
  std::filesystem::path motion;     ///< File of `source`.
  std::filesystem::path character;  ///< A character.toml; empty: the motion's own body.
  /// The reference's feet stand still, and the root is lowered where they do not reach.
  bool plant_feet = true;
  double raise_m = 0.0;  ///< Height by which the floor and the motion are raised.
};

/// Reads the character and puts the motion on its body. A motion of another body is
/// retargeted. A motion of the same body keeps its place, and stays unchanged unless
/// `plant_feet` is set.
/// Errors (kBadInput), with the file: those of read_character_spec(), read_subject(),
/// read_skeleton(), map_body() and make_character().
[[nodiscard]] Result<AdaptBody> make_adapt_body(const Motion& source,
                                                const AdaptBodyOptions& options);

/// Returns the body file that a character.toml names. Empty: it names none, or it cannot
/// be read.
[[nodiscard]] std::filesystem::path body_file_of(const std::filesystem::path& character);

/// Writes a motion of the body: .bvh, or .glb with the mesh of the character's own file.
/// Without such a mesh, a skeleton made by marey gets a mannequin. The file appears whole
/// or not at all.
[[nodiscard]] Status write_adapted(const AdaptBody& body,
                                   const Motion& motion,
                                   const std::filesystem::path& out);

/// Checks, before any work is done, that write_adapted() can write `out`.
[[nodiscard]] Status check_adapted_out(const AdaptBody& body,
                                       const std::filesystem::path& out);

}  // namespace marey::app
