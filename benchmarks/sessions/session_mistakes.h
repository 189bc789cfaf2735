// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/board.h"
#include "core/humanoid.h"
#include "recordings/session/session.h"

namespace marey::benchmarks {

/// Content of a session.toml with one grid of tags, in a form that mistakes can change.
struct PlainSession {
  struct Tag {
    int id = 0;
    HumanBone segment{};
    double size_m = 0.0;
  };
  struct Trial {
    std::string name;
    std::string kind;
    std::string extra;                                        ///< Lines of TOML.
    std::vector<std::pair<std::string, std::string>> videos;  ///< Camera and file.
  };

  double stature_m = 0.0;
  std::string family = "tag36h11";
  std::vector<Tag> tags;
  AprilGrid board;
  std::vector<std::string> cameras;
  std::vector<Trial> trials;

  /// Returns the first trial of a kind. Throws std::runtime_error if there is none.
  [[nodiscard]] Trial& of_kind(std::string_view kind);
  /// Returns the ids of the tags on a segment, in order.
  [[nodiscard]] std::vector<int> ids_on(HumanBone segment) const;
  /// Returns the tag of an id. Throws std::runtime_error if there is none.
  [[nodiscard]] Tag& tag(int id);
};

/// Copies a session. Precondition: its target is a grid, and its tags are of tag36h11.
[[nodiscard]] PlainSession plain(const recordings::Session& session);

/// Writes the text of session.toml.
[[nodiscard]] std::string toml_of(const PlainSession& session);

/// A message must contain at least one word of each list.
using Needed = std::vector<std::vector<std::string>>;

/// A common mistake, and the words that a message about it must contain.
struct SessionMistake {
  std::string name;
  std::function<void(PlainSession&)> make;
  Needed named;
  /// session.toml alone shows it: no video may be decoded first.
  bool is_in_file = false;
  /// The session is still sufficient: exit code 0 is expected.
  bool is_harmless = false;
};

/// Returns 57 mistakes of exchange, renaming, scale, order and omission, and five
/// harmless changes. Preconditions of their use: fifteen segments with tags, three tags
/// on the hips, two on each bone of the limbs, one on hands and feet; a calibration,
/// floor, static and range-of-motion trial; the first motion is a walk; three cameras.
[[nodiscard]] std::vector<SessionMistake> session_mistakes(const PlainSession& right);

}  // namespace marey::benchmarks
