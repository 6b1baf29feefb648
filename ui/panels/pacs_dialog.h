// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "pacs/query.h"
#include "panels/work_dialog.h"
#include "session/pacs_servers.h"

class QCheckBox;
class QComboBox;
class QListWidget;
class QSpinBox;
class QTabWidget;
class QTreeWidget;

namespace glisson::panels {

/// A DICOM server: does it answer, what does it have, fetch and open it, send it what is shown or files. Servers are
/// kept; what is asked for is not.
class PacsDialog : public WorkDialog {
  Q_OBJECT
 public:
  /// source: what is shown, asked when it is sent; null where nothing is open.
  PacsDialog(std::function<std::shared_ptr<const session::ExportSource>()> source, QWidget* parent = nullptr);
  QTabWidget* tabs() const { return tabs_; }

 signals:
  void openWanted(const QString& folder);  ///< that was fetched

 protected:
  void refresh() override;
  bool event(QEvent* event) override;

 private:
  QWidget* makeServer();
  QWidget* makeFind();
  QWidget* makeSend();
  QWidget* makeKeys();
  void showServer(int index);
  void keepServer();
  void addServer();
  void removeServer();
  session::PacsServer server() const;
  pacs::Query query() const;
  std::vector<session::FetchWish> chosen() const;
  void echo();
  void find();
  void fetch();
  void send();
  void show_(const pacs::Found& found);
  void say(const QString& text, bool bad = false);
  void refreshTicks();
  std::function<std::shared_ptr<const session::ExportSource>()> source_;
  std::vector<session::PacsServer> servers_;
  bool filling_ = false;
  QTabWidget* tabs_;
  QComboBox* names_;
  QLineEdit *host_, *called_, *calling_;
  QSpinBox *port_, *receivePort_;
  QCheckBox *move_, *showNames_;
  QLineEdit *patientId_, *patientName_, *date_, *modality_, *description_, *accession_, *folder_ = nullptr;
  QTreeWidget* found_;
  std::vector<std::pair<const session::FormatOffer*, QCheckBox*>> ticks_;
  QListWidget* files_;
  QPushButton *echo_, *remove_, *find_, *fetch_ = nullptr, *open_ = nullptr, *send_ = nullptr;
  QLabel* said_;
  QString fetched_;
};

}  // namespace glisson::panels
