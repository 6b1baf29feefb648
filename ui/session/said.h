// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QStringList>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace glisson::session {

/// A fact about an input or a result in the reader's language: the texts of core/base/diagnostics.def have their
/// translations in the catalogue of the window, under "diagnostics".
QString said(const Diagnostic& diagnostic);

/// Texts that core made, in their order: those of the diagnostics in the reader's language, the others as they are.
QStringList said(const std::vector<std::string>& texts, const Diagnostics& diagnostics);

/// A reason that core gives, without the options of the command line that it names: "check --host" is "check the
/// address".
QString withoutOptions(QString reason);

/// A step of a plan, or what work tells of its progress, in words and in the reader's language: "atlas-solve" is
/// "solving with the atlas stiffness". What is not known stays as it is.
QString stepInWords(const QString& step);

}  // namespace glisson::session
