// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>

#include "pacs/detail/association.h"
#include "pacs/detail/syntaxes.h"
#include "pacs/detail/trouble.h"
#include "pacs/node.h"

namespace glisson::pacs {

using namespace detail;

double echo(const Node& node, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  Association association(node, {{verification, plainSyntaxes()}}, progress);
  const int context = association.need(verification, "verification (C-ECHO)").context;
  Channel& channel = association.channel();
  channel.send(context, Command::of(EchoRequest, channel.nextMessageId(), verification));
  const Channel::Message answer = channel.receiveAnswer();
  const std::uint16_t status = answer.command.wordOr(Status, 0x0110);
  if (answer.command.wordOr(Field, 0) != EchoResponse || status != 0)
    throw NetworkError("the server at " + placeOf(node) + " answered C-ECHO: " + meaningOf(status, node.callingTitle));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  association.release();
  return seconds;
}

}  // namespace glisson::pacs
