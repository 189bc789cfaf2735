// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/commands.h"
#include "core/extension.h"
#include "recordings/gltf.h"

namespace marey::app {

Exit run_mannequin(const recordings::MannequinOptions& options,
                   const recordings::MannequinStyle& style,
                   const std::filesystem::path& out,
                   Console& console) {
  if (kind_by_extension(out) != ".glb") {
    return console.fail(bad_input(
        out.string(), "a mannequin is written as GLB alone", "name the result .glb"));
  }
  const Proportions proportions = recordings::mannequin_proportions(options);
  const Status ok =
      recordings::write_character(out,
                                  make_humanoid(proportions),
                                  recordings::make_mannequin_mesh(proportions, style));
  if (!ok) return console.fail(ok.error());
  console.say("mannequin: " + out.string());
  return Exit::kOk;
}

}  // namespace marey::app
