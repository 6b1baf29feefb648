// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "panels/work_dialog.h"
#include "session/export_formats.h"

class QCheckBox;
class QTextBrowser;

namespace glisson::panels {

/// Standard files of what is shown: a tick for each format, a folder, and afterwards what was written and what was
/// refused.
class ExportDialog : public WorkDialog {
  Q_OBJECT
 public:
  /// source: taken as it is; a case that changes meanwhile is exported as it was.
  explicit ExportDialog(session::ExportSource source, QWidget* parent = nullptr);

 protected:
  void refresh() override;

 private:
  QWidget* makeTicks();
  void addGroup(session::FormatGroup group, QVBoxLayout* into);
  QString whyNot(session::FormatNeeds needs) const;
  session::ExportWish wish() const;
  void start();
  void tell(const pipeline::Exported& done, const QString& reason);
  session::ExportSource source_;
  std::vector<std::pair<const session::FormatOffer*, QCheckBox*>> ticks_;
  QLineEdit *folder_, *case_, *reader_;
  QCheckBox* replace_;
  QTextBrowser* told_;
  QPushButton* start_;
};

}  // namespace glisson::panels
