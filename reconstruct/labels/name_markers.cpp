// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/name_markers.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "core/base/assert.h"
#include "reconstruct/labels/label_sets.h"
#include "reconstruct/labels/label_words.h"

namespace marey::reconstruct {
namespace {

/// Meaning of a label in a set. A null landmark: not a marker on the body.
struct Meaning {
  const Landmark* landmark = nullptr;
  /// The side is the last letter alone: SidedLabel::needs_other_side.
  bool needs_other_side = false;
};

/// The rows of one set, by plain label with its side.
using Meanings = std::map<std::string, Meaning, std::less<>>;

std::string replaced(std::string_view text, char mark, std::string_view by) {
  std::string out(text);
  const std::size_t at = out.find(mark);
  if (at != std::string::npos) out.replace(at, 1, by);
  return out;
}

void add(Meanings& meanings,
         const std::string& label,
         std::string_view name,
         bool needs_other_side) {
  const Landmark* landmark = name.empty() ? nullptr : find_landmark(name);
  MAREY_ASSERT(name.empty() || landmark != nullptr);
  meanings.emplace(label, Meaning{landmark, needs_other_side});
}

/// Adds all spellings of the label of a row that has no per cent sign.
void add_row(Meanings& meanings, std::string_view label, std::string_view landmark) {
  const std::size_t mark = label.find('?');
  if (mark == std::string_view::npos) {
    add(meanings, std::string(label), landmark, false);
    return;
  }
  for (const std::string_view side : {"left", "right"}) {
    const std::string name = replaced(landmark, '?', std::string(side) + "_");
    for (const std::string_view word : {side, side.substr(0, 1)}) {
      add(meanings, replaced(label, '?', word), name, false);
      if (mark > 0) continue;
      add(meanings, std::string(label.substr(1)).append(word), name, word.size() == 1);
    }
  }
}

Meanings meanings_of(const LabelSet& set) {
  Meanings meanings;
  for (const LabelRow& row : set.rows) {
    if (row.label.find('%') == std::string_view::npos) {
      add_row(meanings, row.label, row.landmark);
      continue;
    }
    for (const std::string_view point : {"o", "a", "l", "p"}) {
      add_row(meanings, replaced(row.label, '%', point), row.landmark);
    }
  }
  return meanings;
}

const std::vector<Meanings>& all_meanings() {
  static const std::vector<Meanings> all = [] {
    std::vector<Meanings> sets;
    for (const LabelSet& set : label_sets()) sets.push_back(meanings_of(set));
    return sets;
  }();
  return all;
}

/// Returns true if `label` is another label with a number appended: "LASI_2". File
/// readers number equal labels in this way.
bool is_second(const std::string& label, const std::set<std::string_view>& labels) {
  const std::size_t digits = label.find_last_not_of("0123456789");
  if (digits == std::string::npos || digits + 1 == label.size() || digits == 0 ||
      label[digits] != '_') {
    return false;
  }
  return labels.contains(std::string_view(label).substr(0, digits));
}

/// Returns true for "t4", "l3": a vertebra, or the fourth marker of a cluster.
bool is_vertebra(std::string_view plain) {
  return (plain.size() == 2 || plain.size() == 3) &&
         std::string_view("tls").find(plain[0]) != std::string_view::npos &&
         plain.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// Minimum number of labels that a set must contain: three may agree by chance.
constexpr std::size_t kMin = 4;

/// The labels of one subject, without their prefix.
class LabelGroup {
 public:
  explicit LabelGroup(std::vector<std::string> labels) : labels_(std::move(labels)) {
    for (const std::string& label : labels_) {
      given_.insert(label);
      plain_.push_back(plain_label(label));
      for (const SidedLabel& sided : sides_of(label)) {
        sides_[sided.stem].insert(sided.side);
      }
    }
    choose_set();
  }

  /// Returns the name of the set that contains most of the known labels; empty if none
  /// does.
  [[nodiscard]] std::string_view set() const {
    std::size_t understood = 0;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (landmark(i) != nullptr || (set_ && meaning(i, *set_) != nullptr)) ++understood;
    }
    constexpr std::size_t kMinCovered = 8;  // Fewer are in many sets.
    const bool explains =
        set_ && covered_ >= kMinCovered && 10 * covered_ >= 7 * understood;
    return explains ? label_sets()[*set_].name : std::string_view();
  }

  [[nodiscard]] std::vector<const Landmark*> landmarks() const {
    std::vector<const Landmark*> found;
    for (std::size_t i = 0; i < labels_.size(); ++i) found.push_back(landmark(i));
    return found;
  }

  /// Returns which labels are known not to be markers on the body.
  [[nodiscard]] std::vector<bool> computed() const {
    std::vector<bool> found;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      const Meaning* known = known_meaning(i);
      found.push_back(known != nullptr && known->landmark == nullptr);
    }
    return found;
  }

 private:
  [[nodiscard]] const Meaning* meaning(std::size_t label, std::size_t set) const {
    const Meanings& meanings = all_meanings()[set];
    const auto at = meanings.find(plain_[label]);
    if (at == meanings.end()) return nullptr;
    if (at->second.needs_other_side && !is_side_known(label)) return nullptr;
    return &at->second;
  }

  [[nodiscard]] bool is_side_known(std::size_t label) const {
    for (const SidedLabel& sided : sides_of(labels_[label])) {
      if (!plain_[label].starts_with(sided.stem)) continue;
      if (!sided.needs_other_side || sides_.at(sided.stem).size() == 2) return true;
    }
    return false;
  }

  void choose_set() {
    for (std::size_t s = 0; s < label_sets().size(); ++s) {
      if (label_sets()[s].name.empty()) continue;
      std::size_t covered = 0;
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        if (meaning(i, s) != nullptr) ++covered;
      }
      if (covered < kMin || covered <= covered_) continue;
      if (label_sets()[s].alone && 2 * covered < labels_.size()) continue;
      covered_ = covered;
      set_ = s;
    }
  }

  /// Returns the meaning in the sets; nullptr if no set contains the label.
  [[nodiscard]] const Meaning* known_meaning(std::size_t label) const {
    if (set_) {
      if (const Meaning* known = meaning(label, *set_)) return known;
    }
    if (is_second(labels_[label], given_)) return nullptr;
    for (std::size_t s = 0; s < label_sets().size(); ++s) {
      if (label_sets()[s].alone) continue;
      if (is_vertebra(plain_[label]) && !knows_the_spine()) continue;
      if (const Meaning* known = meaning(label, s)) return known;
    }
    return nullptr;
  }

  [[nodiscard]] const Landmark* landmark(std::size_t label) const {
    if (const Meaning* known = known_meaning(label)) return known->landmark;
    if (is_second(labels_[label], given_)) return nullptr;
    return segment_of_words(labels_[label]);
  }

  [[nodiscard]] bool knows_the_spine() const {
    constexpr std::array<std::string_view, 4> kOfTheTrunk{"c7", "cv7", "xiph", "sacrum"};
    return std::any_of(plain_.begin(), plain_.end(), [&](const std::string& label) {
      return std::find(kOfTheTrunk.begin(), kOfTheTrunk.end(), label) !=
             kOfTheTrunk.end();
    });
  }

  std::vector<std::string> labels_;
  std::set<std::string_view> given_;
  std::vector<std::string> plain_;
  std::map<std::string, std::set<BodySide>> sides_;  ///< By stem.
  std::optional<std::size_t> set_;
  std::size_t covered_ = 0;  ///< Labels that the set knows.
};

bool is_separator(char c) {
  return c == '_' || c == '-' || c == '.' || c == ' ' || c == ':' || c == '/';
}

/// Returns possible lengths of a prefix of all labels: none, up to a separator, all
/// common letters.
std::vector<std::size_t> prefix_lengths(const std::vector<std::string>& labels) {
  std::vector<std::size_t> lengths{0};
  if (labels.size() < 2) return lengths;
  std::size_t shared = labels[0].size();
  for (const std::string& label : labels) {
    shared = std::min(shared, label.size());
    const auto end = labels[0].begin() + static_cast<std::ptrdiff_t>(shared);
    shared = static_cast<std::size_t>(
        std::mismatch(labels[0].begin(), end, label.begin()).first - labels[0].begin());
  }
  for (std::size_t n = 1; n <= shared; ++n) {
    if (n == shared || is_separator(labels[0][n - 1])) lengths.push_back(n);
  }
  return lengths;
}

std::size_t count_named(const std::vector<const Landmark*>& landmarks) {
  return landmarks.size() - static_cast<std::size_t>(
                                std::count(landmarks.begin(), landmarks.end(), nullptr));
}

/// Names one subject's labels, without the prefix whose removal explains most.
MarkerNames name_subject(const std::vector<std::string>& labels) {
  std::optional<MarkerNames> best;
  for (const std::size_t length : prefix_lengths(labels)) {
    std::vector<std::string> rest;
    rest.reserve(labels.size());
    for (const std::string& label : labels) rest.push_back(label.substr(length));
    const LabelGroup group(std::move(rest));
    MarkerNames names;
    names.set = group.set();
    names.prefix = labels[0].substr(0, length);
    names.landmarks = group.landmarks();
    names.is_computed = group.computed();
    if (best && count_named(names.landmarks) <= count_named(best->landmarks)) continue;
    best = std::move(names);
  }
  return *best;
}

struct Subject {
  std::string prefix;  ///< "Bob:"
  std::vector<std::size_t> markers;
  std::vector<std::string> labels;  ///< Without the prefix.
};

std::vector<Subject> subjects_of(std::span<const std::string> labels) {
  std::vector<Subject> subjects;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::size_t colon = labels[i].rfind(':');
    const std::size_t length = colon == std::string::npos ? 0 : colon + 1;
    const std::string prefix = labels[i].substr(0, length);
    auto at = std::find_if(subjects.begin(), subjects.end(), [&](const Subject& subject) {
      return subject.prefix == prefix;
    });
    if (at == subjects.end()) {
      subjects.push_back({prefix, {}, {}});
      at = std::prev(subjects.end());
    }
    at->markers.push_back(i);
    at->labels.push_back(labels[i].substr(length));
  }
  return subjects;
}

}  // namespace

MarkerNames name_markers(std::span<const std::string> labels) {
  MarkerNames best;
  best.landmarks.assign(labels.size(), nullptr);
  best.is_computed.assign(labels.size(), false);
  std::size_t maximum = 0;
  std::size_t with_names = 0;
  for (const Subject& subject : subjects_of(labels)) {
    const MarkerNames names = name_subject(subject.labels);
    const std::size_t named = count_named(names.landmarks);
    if (named >= kMin) ++with_names;
    const bool is_first_known = best.set.empty() && maximum == 0 && !names.set.empty();
    if (named <= maximum && !is_first_known) continue;
    maximum = named;
    best.set = names.set;
    best.prefix = subject.prefix + names.prefix;
    best.landmarks.assign(labels.size(), nullptr);
    best.is_computed.assign(labels.size(), false);
    for (std::size_t i = 0; i < subject.markers.size(); ++i) {
      best.landmarks[subject.markers[i]] = names.landmarks[i];
      best.is_computed[subject.markers[i]] = names.is_computed[i];
    }
  }
  if (with_names > 1) {
    // Markers belong to one subject only.
    best.is_ignored.assign(labels.size(), false);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      best.is_ignored[i] = !labels[i].starts_with(best.prefix);
    }
    best.notes.push_back("the labels belong to several subjects: only those of \"" +
                         best.prefix + "\" are used");
  }
  if (maximum == 0 && !best.set.empty()) {
    best.notes.push_back("these are the labels of " + best.set +
                         ", which are computed points, not markers on the body");
  }
  return best;
}

}  // namespace marey::reconstruct
