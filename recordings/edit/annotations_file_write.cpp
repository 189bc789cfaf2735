// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/edit/annotations_check.h"
#include "recordings/edit/annotations_file.h"

namespace marey::recordings {
namespace {

/// Appends a JSON string. Precondition: UTF-8.
void append_json_text(std::string& out, const std::string& text) {
  out += nlohmann::json(text).dump();
}

/// Appends the number; JSON reads a negative zero as an integer without a sign.
void append_json_number(std::string& out, double value) {
  append_exact(out, value + 0.0);
}

/// Appends ",", unless it is the first of a list, and a line end.
void next_line(std::string& out, bool is_first) {
  out += is_first ? "\n" : ",\n";
}

void append_note(std::string& out, const Annotation& note) {
  out += "    {\"text\": ";
  append_json_text(out, note.text);
  out += ", \"start_s\": ";
  append_json_number(out, note.start_s);
  out += ", \"end_s\": ";
  append_json_number(out, note.end_s);
  out += "}";
}

void append_curve(std::string& out, const ValueCurve& curve) {
  out += "    {\"name\": ";
  append_json_text(out, curve.name);
  out += ", \"values\": [";
  for (std::size_t k = 0; k < curve.values.size(); ++k) {
    if (k > 0) out += ", ";
    append_json_number(out, curve.values[k]);
  }
  out += "]}";
}

}  // namespace

Result<std::string> annotations_text(const Annotations& annotations) {
  if (const Status ok = check_annotations(annotations, "annotations"); !ok) {
    return ok.error();
  }
  std::string out = "{\n  \"format\": 1,\n  \"notes\": [";
  for (std::size_t k = 0; k < annotations.notes.size(); ++k) {
    next_line(out, k == 0);
    append_note(out, annotations.notes[k]);
  }
  out += annotations.notes.empty() ? "],\n" : "\n  ],\n";
  out += "  \"curves\": [";
  for (std::size_t k = 0; k < annotations.curves.size(); ++k) {
    next_line(out, k == 0);
    append_curve(out, annotations.curves[k]);
  }
  out += annotations.curves.empty() ? "]\n}\n" : "\n  ]\n}\n";
  return out;
}

Status write_annotations(const std::filesystem::path& path,
                         const Annotations& annotations) {
  Result<std::string> text = annotations_text(annotations);
  if (text) return write_file(path, *text);
  Error error = text.error();
  error.where = path.string() + error.where.substr(std::string("annotations").size());
  return error;
}

}  // namespace marey::recordings
