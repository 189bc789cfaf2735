// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/explain_problems.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace marey::library {
namespace {

constexpr int kNear = 3;

/// Kinds of problems that a kind causes.
struct Cause {
  std::string_view kind;
  bool everywhere = false;   ///< Else near its own frames.
  std::string_view effects;  ///< Between spaces.
};

constexpr std::array kCauses{
    Cause{"scale",
          true,
          " rate swap cut spike jitter tilt float slide sink limits self flip "},
    Cause{"sides", true, " limits self slide float sink scale swap "},
    Cause{"rate", true, " spike jitter slide flip cut "},
    Cause{"swap", false, " flip cut frozen spike slide limits self sink float "},
    Cause{"flip", false, " cut spike limits self "},
    Cause{"frozen", false, " spike cut slide limits self "},
    Cause{"cut", false, " spike slide "},
    Cause{"spike", false, " slide limits self sink "},
    Cause{"jitter", true, " slide sink "},
    Cause{"tilt", true, " float sink slide "},
    Cause{"float", true, " sink "},
};

bool is_effect(const Cause& cause, std::string_view kind) {
  return cause.effects.find(" " + std::string(kind) + " ") != std::string_view::npos;
}

bool are_near(const FrameRange& a, const FrameRange& b) {
  return a.first <= b.last + kNear && b.first <= a.last + kNear;
}

}  // namespace

void remove_explained(std::vector<ClipProblem>& problems) {
  // Half a cycle of a gait cut out exchanges left and right once, and never back.
  std::erase_if(problems, [&](const ClipProblem& problem) {
    return problem.kind == "swap" && problem.frames.first == problem.frames.last &&
           std::any_of(problems.begin(), problems.end(), [&](const ClipProblem& other) {
             return other.kind == "cut" && are_near(other.frames, problem.frames);
           });
  });
  for (const Cause& cause : kCauses) {
    std::vector<FrameRange> places;
    for (const ClipProblem& problem : problems) {
      if (problem.kind == cause.kind) places.push_back(problem.frames);
    }
    if (places.empty()) continue;
    std::erase_if(problems, [&](const ClipProblem& problem) {
      return is_effect(cause, problem.kind) &&
             (cause.everywhere ||
              std::any_of(places.begin(), places.end(), [&](const FrameRange& frames) {
                return are_near(frames, problem.frames);
              }));
    });
  }
}

std::string main_kind(std::span<const ClipProblem> problems,
                      std::span<const FigureRule> rules) {
  for (const FigureRule& rule : rules) {
    const bool found =
        std::any_of(problems.begin(), problems.end(), [&](const ClipProblem& problem) {
          return problem.kind == rule.kind;
        });
    if (found) return std::string(rule.kind);
  }
  return {};
}

}  // namespace marey::library
