// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/keys.h"

#include <QCoreApplication>
#include <QKeyEvent>
#include <QSettings>

namespace glisson::panels {

using tools::Command;

namespace {

QList<QKeySequence> shipped(Command command) {
  QList<QKeySequence> keys;
  for (const QString& key : QString::fromLatin1(tools::entryOf(command).keys).split(QLatin1Char(' ')))
    keys << QKeySequence(key, QKeySequence::PortableText);
  return keys;
}

QString settingOf(Command command) {
  return QStringLiteral("keys/") + QString::fromLatin1(tools::entryOf(command).id);
}

}  // namespace

QString nameOf(Command command) {
  return QCoreApplication::translate("keymap", tools::entryOf(command).what);
}

Keys::Keys(QObject* parent) : QObject(parent) {
  load();
}

void Keys::load() {
  const QSettings settings;
  for (const tools::KeyEntry& e : tools::keyTable()) {
    auto& keys = keys_[static_cast<std::size_t>(e.command)];
    keys = shipped(e.command);
    const QString own = settings.value(settingOf(e.command)).toString();
    if (!own.isEmpty()) keys = {QKeySequence(own, QKeySequence::PortableText)};
  }
}

std::optional<Command> Keys::commandFor(const QKeyEvent& event) const {
  const auto modifiers = event.modifiers() & ~Qt::KeypadModifier;
  const QKeySequence exact(QKeyCombination(modifiers, static_cast<Qt::Key>(event.key())));
  // "+" or "[" may need Shift or AltGr on a keyboard: then the sign counts, not how it is typed.
  const bool sign = event.key() < 0x100 && !QChar(event.key()).isLetterOrNumber();
  const QKeySequence bare(sign ? event.key() : 0);
  for (const QKeySequence& wanted : {exact, bare}) {
    if (wanted.isEmpty()) continue;
    for (std::size_t c = 0; c < tools::commandCount; ++c)
      if (keys_[c].contains(wanted)) return static_cast<Command>(c);
  }
  return std::nullopt;
}

QString Keys::text(Command command) const {
  return of(command).isEmpty() ? QString() : of(command).front().toString(QKeySequence::NativeText);
}

QString Keys::tip(Command command) const {
  return QStringLiteral("%1 (%2)").arg(nameOf(command), text(command));
}

std::optional<Command> Keys::set(Command command, const QKeySequence& key) {
  for (std::size_t c = 0; c < tools::commandCount; ++c)
    if (static_cast<Command>(c) != command && keys_[c].contains(key)) return static_cast<Command>(c);
  keys_[static_cast<std::size_t>(command)] = {key};
  QSettings().setValue(settingOf(command), key.toString(QKeySequence::PortableText));
  emit changed();
  return std::nullopt;
}

void Keys::reset() {
  QSettings().remove(QStringLiteral("keys"));
  load();
  emit changed();
}

}  // namespace glisson::panels
