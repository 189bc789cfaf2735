// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/clip_tables.h"

#include <cstddef>
#include <initializer_list>

#include "recordings/base/number_text.h"

namespace marey::app {
namespace {

std::string exact(double value) {
  std::string text;
  recordings::append_exact(text, value);
  return text;
}

std::string csv_line(std::initializer_list<std::string_view> fields) {
  std::string line;
  bool is_first = true;
  for (const std::string_view field : fields) {
    if (!is_first) line += ',';
    is_first = false;
    append_csv(line, field);
  }
  return line;
}

}  // namespace

void append_csv(std::string& line, std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
    line += field;
    return;
  }
  line += '"';
  for (const char c : field) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

std::string clip_columns() {
  return "clip_id,name,source,source_id,body,subject,first_frame,last_frame,rate_hz,"
         "seconds,quality,split,licence,duplicate_of,mirror_of";
}

std::string clip_line(const ClipRecord& record) {
  const Provenance& origin = record.provenance;
  return csv_line({record.clip_id,
                   record.name,
                   origin.path,
                   origin.source_id,
                   record.body,
                   origin.subject,
                   std::to_string(record.first_frame),
                   std::to_string(record.last_frame),
                   exact(record.rate_hz),
                   exact(record.duration_s()),
                   name(record.quality),
                   record.split,
                   origin.licence,
                   record.duplicate_of,
                   record.mirror_of});
}

std::string clips_csv(std::span<const ClipRecord> records) {
  std::string text = clip_columns() + "\n";
  for (const ClipRecord& record : records) text += clip_line(record) + "\n";
  return text;
}

std::string figures_csv(std::span<const ClipRecord> records) {
  std::string text = "clip_id,figure,value,verdict,joint,first_frame,last_frame\n";
  for (const ClipRecord& record : records) {
    for (const ClipFigure& figure : record.figures) {
      const bool has_frames = figure.frames.has_value();
      text += csv_line({record.clip_id,
                        figure.name,
                        exact(figure.value),
                        figure.verdict ? name(*figure.verdict) : "",
                        figure.joint,
                        has_frames ? std::to_string(figure.frames->first) : "",
                        has_frames ? std::to_string(figure.frames->last) : ""}) +
              "\n";
    }
  }
  return text;
}

std::string labels_csv(std::span<const ClipRecord> records) {
  std::string text = "clip_id,start_s,end_s,label,by,certainty\n";
  for (const ClipRecord& record : records) {
    for (const ClipLabel& label : record.labels) {
      text += csv_line({record.clip_id,
                        exact(label.start_s),
                        exact(label.end_s),
                        label.text,
                        label.by,
                        exact(label.certainty)}) +
              "\n";
    }
  }
  return text;
}

std::string splits_csv(std::span<const ClipRecord> records) {
  std::string text = "clip_id,split,subject,name\n";
  for (const ClipRecord& record : records) {
    text +=
        csv_line({record.clip_id, record.split, record.provenance.subject, record.name}) +
        "\n";
  }
  return text;
}

}  // namespace marey::app
