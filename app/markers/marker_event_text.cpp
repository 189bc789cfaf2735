// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/marker_event_text.h"

#include "core/base/printable.h"

namespace marey::app {

std::string text_of_event(const recordings::MarkerEvent& event) {
  const bool has_side = event.context == "Left" || event.context == "Right";
  const std::string side = event.context == "Left" ? "left" : "right";
  if (has_side && event.label == "Foot Strike") return side + ".strike";
  if (has_side && event.label == "Foot Off") return side + ".toe_off";
  std::string out = event.context;
  if (!out.empty() && !event.label.empty()) out += " ";
  out += event.label;
  return out.empty() ? "event" : printable(out);
}

}  // namespace marey::app
