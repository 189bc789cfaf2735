// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/marker_labels.h"

#include <map>
#include <set>
#include <utility>

namespace marey::recordings {
namespace {

/// Returns the label without surrounding blanks; control characters, which text files
/// cannot hold, become blanks.
std::string printable(std::string label) {
  for (char& c : label) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') c = ' ';
  }
  const std::size_t begin = label.find_first_not_of(' ');
  if (begin == std::string::npos) return {};
  return label.substr(begin, label.find_last_not_of(' ') - begin + 1);
}

}  // namespace

std::vector<std::string> distinct_labels(std::vector<std::string> labels,
                                         std::size_t count,
                                         std::vector<std::string>& notes) {
  if (labels.size() > count) {
    notes.push_back("labels of more markers than there are: the last " +
                    std::to_string(labels.size() - count) + " are left out");
  }
  labels.resize(count);
  std::size_t unnamed = 0;
  for (std::size_t i = 0; i < count; ++i) {
    labels[i] = printable(std::move(labels[i]));
    if (!labels[i].empty()) continue;
    labels[i] = "unnamed_" + std::to_string(i + 1);
    ++unnamed;
  }
  if (unnamed > 0) {
    notes.push_back(std::to_string(unnamed) +
                    " markers have no label; they are called unnamed_ and their number");
  }
  std::set<std::string> taken(labels.begin(), labels.end());
  std::set<std::string> seen;
  std::map<std::string, int> counts;
  std::size_t doubled = 0;
  std::string first_doubled;
  for (std::string& label : labels) {
    if (seen.insert(label).second) continue;
    if (doubled == 0) first_doubled = label;
    ++doubled;
    int& number = counts.try_emplace(label, 1).first->second;
    std::string fresh;
    do {
      fresh = label + "_" + std::to_string(++number);
    } while (!taken.insert(fresh).second);
    label = fresh;
    seen.insert(label);
  }
  if (doubled > 0) {
    notes.push_back("labels that occur before, to which a number is appended: " +
                    std::to_string(doubled) + " (" + first_doubled + "...)");
  }
  return labels;
}

}  // namespace marey::recordings
