// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

class QLabel;
class QVBoxLayout;

namespace glisson::session {
class Session;
enum class Remedy;
}  // namespace glisson::session

namespace glisson::panels {

/// How far to trust the last run: what is said against both answers, what to do about it, and buttons that do it.
class TrustPanel : public QWidget {
  Q_OBJECT
 public:
  /// textName: object name of the label that holds the words.
  TrustPanel(session::Session& session, const QString& textName, QWidget* parent = nullptr);
  void show_();  ///< the last run, or that there is none
  /// Why the results are not those of what is set now; empty where they are.
  static QString outdated(const session::Session& session);

 signals:
  void runWanted();  ///< the parameters have the remedy

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void offer(session::Remedy remedy);
  QString sizeOfCells() const;
  void takeOffers();
  session::Session& session_;
  QLabel* words_;
  QVBoxLayout* remedies_;
};

}  // namespace glisson::panels
