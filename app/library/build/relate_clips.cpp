// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/relate_clips.h"

namespace marey::app {

Status relate_clips(const BuildInputs& inputs,
                    const std::string& search,
                    std::vector<ClipRecord>& records,
                    std::vector<std::string>& remarks) {
  (void)inputs;
  (void)search;
  (void)records;
  (void)remarks;
  return Done{};
}

}  // namespace marey::app
