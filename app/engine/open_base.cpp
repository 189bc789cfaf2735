// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/open_base.h"

#include <utility>

#include "app/motion/error_of_file.h"
#include "recordings/moves/read_moves.h"

namespace marey::app {

OpenedBase open_base(const std::filesystem::path& file) {
  auto moves = recordings::read_moves(file);
  if (!moves) return moves.error();
  auto base = engine::MotionBase::make(*std::move(moves));
  if (base || base.error().where.starts_with(file.string())) return base;
  return of_file(file, base.error());
}

}  // namespace marey::app
