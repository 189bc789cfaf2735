// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/clips/motion_base.h"

#include "app/motion/motion_files.h"
#include "app/shell/console.h"
#include "core/base/result.h"
#include "core/character.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// Arguments of `marey blend`.
struct BlendArguments {
  std::string from;  ///< A: a motion or recipe, or with `base` the name of a clip.
  std::string to;    ///< B.
  std::filesystem::path out;
  std::filesystem::path base;    ///< Empty: A and B are files.
  std::filesystem::path avatar;  ///< Empty: the body of A.
  double at_s = 0.0;             ///< Time in A.
  double fade_s = 0.3;
  std::string kind = "auto";
  std::optional<double> seconds{};  ///< Duration of the result. nullopt: to the end of B.
  bool json = false;
};

/// The clips of a transition and the body that plays them.
struct BlendInputs {
  std::shared_ptr<const engine::MotionBase> base;
  std::size_t from = 0;  ///< Position of A in the base.
  std::size_t to = 0;
  Character character;
  retarget::BodyMap map;  ///< For the character's skeleton.
  BodyLook look;

  [[nodiscard]] const MotionClip& from_clip() const { return base->clip(from); }
  [[nodiscard]] const MotionClip& to_clip() const { return base->clip(to); }
};

/// Returns the format of the result by its extension. Errors (bad input): no format of a
/// motion; the path is a folder, or a file that is read, also by a recipe.
[[nodiscard]] Result<MotionFormat> check_blend_out(const BlendArguments& args);

/// Reads both motions, or the base, and the body. With a base and without an avatar, the
/// body is an average one with the legs of A. Checks that `format` can be written.
/// Errors: those of read_base_sources(), make_moves(), open_base(), open_avatar() and
/// check_result_format(), with the file; a folder; a recipe with several results; a clip
/// that the base does not have.
[[nodiscard]] Result<BlendInputs> read_blend_inputs(const BlendArguments& args,
                                                    MotionFormat format,
                                                    Console& console);

}  // namespace marey::app
