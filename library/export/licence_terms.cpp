// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/licence_terms.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "core/base/lower_case.h"

namespace marey::library {
namespace {

constexpr std::array<std::string_view, 10> kFreeOfConditions{"cc0-1.0",
                                                             "cc-pddc",
                                                             "pddl-1.0",
                                                             "unlicense",
                                                             "0bsd",
                                                             "mit-0",
                                                             "wtfpl",
                                                             "cdla-permissive-1.0",
                                                             "cdla-permissive-2.0",
                                                             "c-uda-1.0"};

constexpr std::array<std::string_view, 17> kWithAttribution{"mit",
                                                            "mit-cmu",
                                                            "apache-2.0",
                                                            "bsd-1-clause",
                                                            "bsd-2-clause",
                                                            "bsd-3-clause",
                                                            "bsd-3-clause-clear",
                                                            "bsd-4-clause",
                                                            "isc",
                                                            "zlib",
                                                            "bsl-1.0",
                                                            "odc-by-1.0",
                                                            "ncsa",
                                                            "hpnd",
                                                            "x11",
                                                            "postgresql",
                                                            "afl-3.0"};

constexpr std::array<std::string_view, 23> kSameLicence{
    "odbl-1.0",          "cdla-sharing-1.0",  "gpl-2.0",           "gpl-2.0-only",
    "gpl-2.0-or-later",  "gpl-3.0",           "gpl-3.0-only",      "gpl-3.0-or-later",
    "lgpl-2.1",          "lgpl-2.1-only",     "lgpl-2.1-or-later", "lgpl-3.0",
    "lgpl-3.0-only",     "lgpl-3.0-or-later", "agpl-3.0",          "agpl-3.0-only",
    "agpl-3.0-or-later", "mpl-2.0",           "epl-2.0",           "eupl-1.2",
    "ofl-1.1",           "gfdl-1.3-or-later", "artistic-2.0"};

template <class List>
bool contains(const List& list, std::string_view word) {
  return std::ranges::find(list, word) != std::ranges::end(list);
}

/// Reads "cc-by-nc-sa-4.0", "cc-by-3.0-us". nullopt: none of this family.
std::optional<LicenceTerms> creative_commons(std::string_view id) {
  if (!id.starts_with("cc-by")) return std::nullopt;
  id.remove_prefix(5);
  LicenceTerms terms;
  const auto take = [&](std::string_view part) {
    if (!id.starts_with(part)) return false;
    id.remove_prefix(part.size());
    return true;
  };
  terms.allows_commercial_use = !take("-nc");
  terms.allows_changes = !take("-nd");
  terms.needs_same_licence = terms.allows_changes && take("-sa");
  // SPDX writes both orders: "cc-by-nd-nc-1.0".
  if (take("-nc")) terms.allows_commercial_use = false;
  if (id.size() < 4 || id[0] != '-' || !is_ascii_digit(id[1])) return std::nullopt;
  return terms;
}

/// Tokens of an expression: words and parentheses.
class LicenceParser {
 public:
  explicit LicenceParser(std::string_view text) : rest_(text) { next(); }

  std::optional<LicenceAlternatives> parse() {
    auto all = either(0);
    if (!token_.empty()) return std::nullopt;
    return all;
  }

 private:
  static constexpr std::size_t kMaxAlternatives = 256;
  static constexpr int kMaxDepth = 32;

  void next() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
    std::size_t end = 0;
    if (!rest_.empty() && (rest_.front() == '(' || rest_.front() == ')')) {
      end = 1;
    } else {
      while (end < rest_.size() && rest_[end] != ' ' && rest_[end] != '(' &&
             rest_[end] != ')') {
        ++end;
      }
    }
    token_ = rest_.substr(0, end);
    rest_.remove_prefix(end);
  }

  /// SPDX has operators in capitals; small letters are common.
  [[nodiscard]] bool at(std::string_view word) const {
    return lower_case(token_) == word;
  }

  std::optional<LicenceAlternatives> either(int depth) {
    auto all = both(depth);
    while (all && at("or")) {
      next();
      auto more = both(depth);
      if (!more || all->size() + more->size() > kMaxAlternatives) return std::nullopt;
      all->insert(all->end(), more->begin(), more->end());
    }
    return all;
  }

  std::optional<LicenceAlternatives> both(int depth) {
    auto all = single(depth);
    while (all && at("and")) {
      next();
      const auto more = single(depth);
      if (!more || all->size() * more->size() > kMaxAlternatives) return std::nullopt;
      LicenceAlternatives product;
      for (const auto& left : *all) {
        for (const auto& right : *more) {
          product.push_back(left);
          for (const std::string& id : right) {
            if (!contains(product.back(), id)) product.back().push_back(id);
          }
        }
      }
      all = std::move(product);
    }
    return all;
  }

  std::optional<LicenceAlternatives> single(int depth) {
    if (depth > kMaxDepth || token_.empty()) return std::nullopt;
    if (token_ == "(") {
      next();
      auto inner = either(depth + 1);
      if (token_ != ")") return std::nullopt;
      next();
      return inner;
    }
    if (!is_identifier(token_)) return std::nullopt;
    std::string id(token_);
    next();
    if (at("with")) {
      next();
      if (!is_identifier(token_)) return std::nullopt;
      id.append(" WITH ").append(token_);
      next();
    }
    return LicenceAlternatives{{std::move(id)}};
  }

  static bool is_identifier(std::string_view word) {
    const std::string lower = lower_case(word);
    if (word.empty() || lower == "and" || lower == "or" || lower == "with") return false;
    return std::ranges::all_of(lower, [](char c) {
      return is_ascii_digit(c) || (c >= 'a' && c <= 'z') || c == '-' || c == '.' ||
             c == '+' || c == ':';
    });
  }

  std::string_view rest_;
  std::string_view token_;
};

bool is_allowed(std::string_view text, const LicenceAllowance& allowance) {
  const std::string lower = lower_case(text);
  return std::ranges::any_of(allowance.licences, [&](const std::string& licence) {
    return lower_case(licence) == lower;
  });
}

LicenceBar bar_of(const std::string& id,
                  bool is_changed,
                  const LicenceAllowance& allowance) {
  if (lower_case(id) == "unknown") {
    return allowance.allows_unknown ? LicenceBar::kNone : LicenceBar::kUnknown;
  }
  if (is_allowed(id, allowance)) return LicenceBar::kNone;
  const auto terms = terms_of_licence(id);
  if (!terms) return LicenceBar::kText;
  if (!terms->allows_commercial_use) return LicenceBar::kNonCommercial;
  if (!terms->allows_changes && is_changed) return LicenceBar::kNoDerivatives;
  return LicenceBar::kNone;
}

LicenceDecision decide_alternative(const std::vector<std::string>& ids,
                                   bool is_changed,
                                   const LicenceAllowance& allowance) {
  LicenceDecision out;
  out.applied = ids;
  out.terms.needs_attribution = false;
  for (const std::string& id : ids) {
    if (out.bar == LicenceBar::kNone) out.bar = bar_of(id, is_changed, allowance);
    // Nothing can be concluded from a text.
    const LicenceTerms terms = terms_of_licence(id).value_or(LicenceTerms{});
    out.terms.allows_commercial_use &= terms.allows_commercial_use;
    out.terms.allows_changes &= terms.allows_changes;
    out.terms.needs_attribution |= terms.needs_attribution;
    out.terms.needs_same_licence |= terms.needs_same_licence;
  }
  return out;
}

/// Smaller for a more permissive decision.
auto strictness(const LicenceDecision& decision) {
  const LicenceTerms& terms = decision.terms;
  return std::tuple(decision.bar != LicenceBar::kNone,
                    !terms.allows_commercial_use,
                    !terms.allows_changes,
                    terms.needs_same_licence,
                    terms.needs_attribution,
                    decision.applied.size());
}

}  // namespace

std::optional<LicenceTerms> terms_of_licence(std::string_view identifier) {
  std::string id = lower_case(identifier);
  // An exception only adds permissions.
  if (const std::size_t with = id.find(" with "); with != std::string::npos) {
    id.resize(with);
  }
  if (id.ends_with('+')) id.pop_back();
  if (const auto terms = creative_commons(id)) return terms;
  if (contains(kFreeOfConditions, id)) return LicenceTerms{true, true, false, false};
  if (contains(kWithAttribution, id)) return LicenceTerms{};
  if (contains(kSameLicence, id)) return LicenceTerms{true, true, true, true};
  return std::nullopt;
}

std::optional<LicenceAlternatives> parse_licence(std::string_view expression) {
  return LicenceParser(expression).parse();
}

std::string_view name(LicenceBar bar) {
  switch (bar) {
    case LicenceBar::kNone:
      break;
    case LicenceBar::kUnknown:
      return "states no permission";
    case LicenceBar::kText:
      return "has terms that only a person can judge";
    case LicenceBar::kNonCommercial:
      return "forbids commercial use";
    case LicenceBar::kNoDerivatives:
      return "forbids changed copies";
  }
  return "permits it";
}

LicenceDecision decide_licence(std::string_view expression,
                               bool is_changed,
                               const LicenceAllowance& allowance) {
  if (expression.empty()) expression = "unknown";
  const std::string whole(expression);
  const auto alternatives = parse_licence(expression);
  if (!alternatives) {
    LicenceDecision out;
    out.applied = {whole};
    if (!is_allowed(whole, allowance)) out.bar = LicenceBar::kText;
    return out;
  }
  std::optional<LicenceDecision> best;
  for (const auto& ids : *alternatives) {
    LicenceDecision decision = decide_alternative(ids, is_changed, allowance);
    const bool is_stated = decision.bar != LicenceBar::kUnknown;
    if (is_stated && is_allowed(whole, allowance)) decision.bar = LicenceBar::kNone;
    if (!best || strictness(decision) < strictness(*best)) best = std::move(decision);
  }
  best->is_choice = alternatives->size() > 1;
  return *std::move(best);
}

}  // namespace marey::library
