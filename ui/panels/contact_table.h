// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

class QLabel;
class QTreeWidget;

namespace glisson::session {
class Session;
}
namespace glisson::pipeline {
struct RunResult;
}

namespace glisson::panels {

/// Why the two runs of a result are not compared, in sentences; empty where they are.
QString whyNoDifference(const pipeline::RunResult& result);

/// What bar and liver do to each other in the last run, with either stiffness: travel, force, area, pressure, whether
/// the place bears; how far the two travels differ, or why no difference is given; the kinematics used, and why.
class ContactTable : public QWidget {
  Q_OBJECT
 public:
  explicit ContactTable(session::Session& session, QWidget* parent = nullptr);
  /// Reads the session's result anew.
  void show_();

 private:
  session::Session& session_;
  QTreeWidget* rows_;
  QLabel* words_;
};

}  // namespace glisson::panels
