// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <functional>

#include "session/worker.h"

class QDialogButtonBox;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QVBoxLayout;

namespace glisson::panels {

/// A dialog that works: its form, a line with progress, time left and Cancel while a job runs, and buttons. The form
/// cannot be changed meanwhile. Escape first cancels the job, then closes.
class WorkDialog : public QDialog {
  Q_OBJECT
 public:
  bool busy() const { return worker_.busy(); }
  void reject() override;

 signals:
  void ended(const QString& reason);  ///< a job; reason: empty where it went well

 protected:
  WorkDialog(const char* name, const QString& title, QWidget* parent);
  /// What the derived dialog fills; disabled while a job runs.
  QVBoxLayout* form() const { return form_; }
  /// Beside Close: the button that starts the job.
  QPushButton* addStart(const char* name, const QString& text);
  /// A line for a path, with a button that asks for one; the line is returned.
  QLineEdit* pathLine(const char* name, const QString& tip, const std::function<QString()>& ask, QVBoxLayout* into);
  /// Does the job; then, on this thread, `done` with the reason why it failed (empty where it went well; "cancelled" in
  /// the reader's language where it was cancelled).
  void work(const QString& what, session::Worker::Job job, std::function<void(const QString& reason)> done);
  /// Called when a job begins or ends, and by the derived dialog when its form changes: which buttons can be pressed.
  virtual void refresh() {}

 private:
  void showWork(bool on);
  session::Worker worker_;
  QWidget *held_, *line_;
  QVBoxLayout* form_;
  QProgressBar* progress_;
  QLabel* what_;
  QPushButton* cancel_;
  QDialogButtonBox* buttons_;
};

}  // namespace glisson::panels
