// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::live {

/// A measured figure of a scene.
struct PageRunFigure {
  std::string name{};
  std::string unit{};
  std::optional<double> value{};  ///< nullopt: not measured yet.
  std::string bound{};            ///< Bound in words; empty: none.
  std::optional<bool> passed{};   ///< nullopt: no bound, or no value.
};

enum class PageRunState { kPlaying, kPaused };

/// State of a scene that runs live, sent a few times a second.
struct PageRun {
  PageRunState state = PageRunState::kPlaying;
  double time_s = 0.0;  ///< Time of the scene.
  double duration_s = 0.0;
  std::vector<PageRunFigure> figures{};
  std::vector<std::string> messages{};
};

/// Returns the message about the run: JSON in one line. Invalid UTF-8 is replaced;
/// non-finite numbers are null.
[[nodiscard]] std::string run_json(const PageRun& run);

/// Place of a target of the scene.
struct PageTarget {
  glm::dvec3 p_in_world{0.0};
  bool held = false;  ///< The user has moved it; its path does not apply.
};

/// Returns the message that moves the targets, which have the order of the scene's
/// constraints.
[[nodiscard]] std::string targets_json(std::span<const PageTarget> targets);

}  // namespace marey::live
