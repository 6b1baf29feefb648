// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <memory>

#include "session/method_study.h"
#include "session/worker.h"

class QLabel;
class QProgressBar;
class QPushButton;
class QTreeWidget;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class PictureView;
}

namespace glisson::panels {

/// Error against run time of every method on this patient, measured on request: the chart, the numbers of its points,
/// and what they say of the default and of the method chosen.
class MethodChart : public QWidget {
  Q_OBJECT
 public:
  explicit MethodChart(session::Session& session, QWidget* parent = nullptr);
  bool isReady() const { return study_ != nullptr; }

 signals:
  void ready();                         ///< chart and numbers are shown
  void stopped(const QString& reason);  ///< cancelled (empty) or failed

 private:
  void measure();
  void forget();
  void show_();
  QString verdict() const;
  session::Session& session_;
  session::Worker worker_;
  std::shared_ptr<const session::MethodStudy> study_;
  views::PictureView* picture_;
  QTreeWidget* rows_;
  QLabel* words_;
  QPushButton *start_, *cancel_;
  QProgressBar* progress_;
};

}  // namespace glisson::panels
