// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace marey::library {

/// Terms of one licence that matter for copies of data.
struct LicenceTerms {
  bool allows_commercial_use = true;
  bool allows_changes = true;
  bool needs_attribution = true;
  bool needs_same_licence = false;  ///< Changed copies keep the licence.
};

/// Returns the terms of an SPDX identifier: Creative Commons (of any version and
/// country), Open Data Commons, CDLA, and usual software licences. nullopt: an identifier
/// that marey does not know, and all of "LicenseRef-". Case has no influence, as SPDX
/// demands.
[[nodiscard]] std::optional<LicenceTerms> terms_of_licence(std::string_view identifier);

/// Alternatives of a licence expression; all licences of one alternative apply together.
using LicenceAlternatives = std::vector<std::vector<std::string>>;

/// Reads an SPDX expression (SPDX 2.3, annex D): identifiers, AND, OR, WITH, parentheses.
/// AND binds more strongly than OR. An exception of WITH stays a part of its identifier.
/// nullopt: not an expression, or one with more than 256 alternatives.
[[nodiscard]] std::optional<LicenceAlternatives> parse_licence(
    std::string_view expression);

/// Licences that a user permits for an export.
struct LicenceAllowance {
  std::vector<std::string> licences;  ///< Identifiers, or whole texts.
  bool allows_unknown = false;        ///< Clips without a licence.
};

/// Reasons against an export.
enum class LicenceBar {
  kNone,
  kUnknown,        ///< No licence is stated.
  kText,           ///< The licence is a text, or an identifier that marey does not know.
  kNonCommercial,  ///< It forbids commercial use.
  kNoDerivatives,  ///< It forbids changed copies, and the clip is changed.
};

/// Returns the reason as the end of a sentence: "forbids commercial use".
[[nodiscard]] std::string_view name(LicenceBar bar);

struct LicenceDecision {
  LicenceBar bar = LicenceBar::kNone;
  /// The licences that apply. If there are alternatives, the most permissive one.
  std::vector<std::string> applied;
  bool is_choice = false;  ///< The expression had alternatives.
  LicenceTerms terms;      ///< The strictest of `applied`.
};

/// Decides whether a clip may be exported, and under which licences. AND: all licences
/// must permit it. OR: the alternative is taken that permits it, with the fewest
/// conditions, and the first of equals. `allowance` lifts kText, kNonCommercial and
/// kNoDerivatives for a licence that it names, and for an expression that it names as a
/// whole. `is_changed`: the copy differs from the original by more than its format.
/// An empty text is "unknown".
[[nodiscard]] LicenceDecision decide_licence(std::string_view expression,
                                             bool is_changed,
                                             const LicenceAllowance& allowance);

}  // namespace marey::library
