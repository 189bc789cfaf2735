// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/file_kind.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/extension.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sqlite.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/takes/live_take_schema.h"
#include "recordings/takes/take_schema.h"

namespace marey::recordings {
namespace {

FileKind kind_of_toml(TomlDocument& document) {
  switch (toml_kind(document)) {
    case TomlKind::kSession:
      return FileKind::kSession;
    case TomlKind::kCalibration:
      return FileKind::kCalibration;
    case TomlKind::kSubject:
      return FileKind::kSubject;
    case TomlKind::kPlan:
      return FileKind::kPlan;
    case TomlKind::kCharacter:
      return FileKind::kCharacter;
    case TomlKind::kFloor:
      return FileKind::kFloor;
    case TomlKind::kBoneMap:
      return FileKind::kBoneMap;
    case TomlKind::kMarkerMap:
      return FileKind::kMarkerMap;
    case TomlKind::kEditRecipe:
      return FileKind::kEditRecipe;
    case TomlKind::kScene:
      return FileKind::kScene;
    case TomlKind::kTrials:
      return FileKind::kTrials;
    case TomlKind::kUnknown:
      break;
  }
  return FileKind::kUnknown;
}

FileKind kind_of_xml(std::string_view text) {
  if (text.find("<opencv_storage") != std::string_view::npos) return FileKind::kLenses;
  if (text.find("<ConstraintsSet") != std::string_view::npos) {
    return FileKind::kConstraints;
  }
  return FileKind::kUnknown;
}

FileKind kind_of_table(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, FileKind>, 5> kHeaders{
      {{"frame,time,joint,x,y,z,sigma", FileKind::kJoints},
       {"frame,time,joint,x,y,z", FileKind::kPlaces},
       {"frame,time,segment,x,y,z,qw,qx,qy,qz,source", FileKind::kSegments},
       {"frame,time,marker,method,sigma", FileKind::kRepair},
       {"# marey detections ", FileKind::kDetections}}};
  for (const auto& [header, kind] : kHeaders) {
    if (text.starts_with(header)) return kind;
  }
  return FileKind::kUnknown;
}

Result<FileKind> kind_of_database(const std::filesystem::path& path) {
  const auto opened = open_recorded(path);
  if (!opened) return opened.error();
  const Database& database = *opened;
  if (!database) return FileKind::kUnknown;
  const std::int64_t application = setting_of(database.get(), "application_id");
  if (application == kTakeApplication) return FileKind::kTake;
  return application == kLiveTakeApplication ? FileKind::kLiveTake : FileKind::kUnknown;
}

}  // namespace

Result<FileKind> file_kind(const std::filesystem::path& path) {
  const std::string extension = kind_by_extension(path);
  if (extension == ".sqlite") return kind_of_database(path);
  const bool is_toml = extension == ".toml";
  const bool is_xml = extension == ".xml";
  const bool is_yaml = extension == ".yaml" || extension == ".yml";
  if (is_yaml) return FileKind::kLenses;
  if (!is_toml && !is_xml && extension != ".csv") return FileKind::kUnknown;
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  if (is_xml) return kind_of_xml(*text);
  if (!is_toml) return kind_of_table(*text);
  Result<TomlDocument> document = parse_toml(*text, path.string());
  if (!document) return document.error();
  return kind_of_toml(*document);
}

}  // namespace marey::recordings
