// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/live/vmc/read_vmc.h"

#include <lo/lo.h>

namespace marey::live {
namespace {

int take(const char* path,
         const char* types,
         lo_arg** arguments,
         int count,
         lo_message /*message*/,
         void* into) {
  ReadMessage read{path, types, {}, {}};
  for (int i = 0; i < count; ++i) {
    switch (types[i]) {
      case 'i':
        read.numbers.push_back(arguments[i]->i);
        break;
      case 'f':
        read.numbers.push_back(arguments[i]->f);
        break;
      case 's':
        read.texts.emplace_back(&arguments[i]->s);
        break;
      default:
        break;
    }
  }
  static_cast<std::vector<ReadMessage>*>(into)->push_back(std::move(read));
  return 0;
}

}  // namespace

std::vector<ReadMessage> read_by_liblo(std::span<const std::uint8_t> packet) {
  std::vector<ReadMessage> messages;
  // Its own port is never used: the packet is handed in.
  const lo_server server = lo_server_new(nullptr, nullptr);
  lo_server_add_method(server, nullptr, nullptr, take, &messages);
  std::vector<std::uint8_t> copy(packet.begin(), packet.end());
  lo_server_dispatch_data(server, copy.data(), copy.size());
  lo_server_free(server);
  return messages;
}

}  // namespace marey::live
