// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/pacs_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QCompleter>
#include <QEvent>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QSpinBox>
#include <QTabWidget>
#include <QTreeWidget>

#include "panels/form.h"

namespace glisson::panels {

namespace {

QLineEdit* lineFor(const char* name, const QString& hint, const QString& tip) {
  auto* line = new QLineEdit;
  line->setObjectName(QString::fromLatin1(name));
  line->setPlaceholderText(hint);
  line->setToolTip(tip);
  line->setAccessibleName(tip);
  return line;
}

QSpinBox* portFor(const char* name, const QString& tip) {
  auto* box = new QSpinBox;
  box->setObjectName(QString::fromLatin1(name));
  box->setRange(1, 65535);
  box->setButtonSymbols(QAbstractSpinBox::NoButtons);
  box->setToolTip(tip);
  box->setAccessibleName(tip);
  return box;
}

}  // namespace

PacsDialog::PacsDialog(std::function<std::shared_ptr<const session::ExportSource>()> source, QWidget* parent)
    : WorkDialog("pacsDialog", tr("PACS"), parent), source_(std::move(source)), tabs_(new QTabWidget) {
  form()->addWidget(makeServer());
  tabs_->setObjectName(QStringLiteral("pacsTabs"));
  tabs_->addTab(makeFind(), tr("Find and fetch"));
  tabs_->addTab(makeSend(), tr("Send"));
  form()->addWidget(tabs_, 1);
  said_ = labelled({}, "text");
  said_->setObjectName(QStringLiteral("pacsSaid"));
  form()->addWidget(said_);
  servers_ = session::keptServers();
  if (servers_.empty()) servers_.push_back({tr("My server"), {}, false, 11112});
  filling_ = true;
  for (const session::PacsServer& s : servers_) names_->addItem(s.name);
  showServer(0);
  connect(tabs_, &QTabWidget::currentChanged, this, [this] { refresh(); });
  resize(860, 760);
  refresh();
}

QWidget* PacsDialog::makeServer() {
  auto* held = new QWidget;
  auto* column = new QVBoxLayout(held);
  column->setContentsMargins(0, 0, 0, 0);
  auto* first = new QHBoxLayout;
  names_ = new QComboBox;
  names_->setObjectName(QStringLiteral("pacsServer"));
  names_->setEditable(true);
  names_->setInsertPolicy(QComboBox::NoInsert);
  names_->setCompleter(nullptr);
  names_->setToolTip(tr("Servers that are kept; the name can be changed"));
  names_->setAccessibleName(tr("Server"));
  auto* add = button("pacsAdd", tr("Add"), {}, tr("One more server"));
  remove_ = button("pacsRemove", tr("Remove"), {}, tr("Forgets this server"));
  echo_ =
      button("pacsEcho", tr("Does it answer?"), {}, tr("Asks the server whether it is there and knows us (C-ECHO)"));
  first->addWidget(names_, 1);
  for (QPushButton* b : {add, remove_, echo_}) first->addWidget(b);
  column->addLayout(first);
  auto* second = new QHBoxLayout;
  host_ = lineFor("pacsHost", tr("Name or address"), tr("The server's name or address"));
  port_ = portFor("pacsPort", tr("The server's port"));
  called_ = lineFor("pacsCalled", tr("Its AE title"), tr("The server's AE title"));
  calling_ = lineFor("pacsCalling", tr("Our AE title"), tr("Our AE title, by which the server knows us"));
  move_ = new QCheckBox(tr("Fetch by C-MOVE, received at"));
  move_->setObjectName(QStringLiteral("pacsMove"));
  move_->setToolTip(tr("For servers without C-GET. They must know our AE title, this computer and this port."));
  receivePort_ = portFor("pacsReceivePort", tr("Our port, to which the server sends"));
  second->addWidget(host_, 2);
  second->addWidget(port_);
  second->addWidget(called_, 1);
  second->addWidget(calling_, 1);
  second->addWidget(move_);
  second->addWidget(receivePort_);
  column->addLayout(second);
  column->addWidget(labelled(tr("The connection is not encrypted: for a trusted network only."), "faint"));
  connect(names_, &QComboBox::activated, this, &PacsDialog::showServer);
  connect(names_->lineEdit(), &QLineEdit::textEdited, this, &PacsDialog::keepServer);
  for (QLineEdit* line : {host_, called_, calling_})
    connect(line, &QLineEdit::textEdited, this, &PacsDialog::keepServer);
  for (QSpinBox* box : {port_, receivePort_}) connect(box, &QSpinBox::valueChanged, this, &PacsDialog::keepServer);
  connect(move_, &QCheckBox::toggled, this, &PacsDialog::keepServer);
  connect(add, &QPushButton::clicked, this, &PacsDialog::addServer);
  connect(remove_, &QPushButton::clicked, this, &PacsDialog::removeServer);
  connect(echo_, &QPushButton::clicked, this, &PacsDialog::echo);
  for (QPushButton* b : {add, remove_, echo_}) b->setAutoDefault(false);
  return held;
}

void PacsDialog::showServer(int index) {
  if (index < 0 || index >= static_cast<int>(servers_.size())) return;
  filling_ = true;
  const session::PacsServer& s = servers_[static_cast<std::size_t>(index)];
  names_->setCurrentIndex(index);
  names_->setEditText(s.name);
  host_->setText(QString::fromStdString(s.node.host));
  port_->setValue(s.node.port);
  called_->setText(QString::fromStdString(s.node.calledTitle));
  calling_->setText(QString::fromStdString(s.node.callingTitle));
  move_->setChecked(s.move);
  receivePort_->setValue(s.receivePort);
  filling_ = false;
  found_->clear();
  say({});
  refresh();
}

session::PacsServer PacsDialog::server() const {
  session::PacsServer s = servers_[static_cast<std::size_t>(std::max(names_->currentIndex(), 0))];
  s.name = names_->currentText();
  s.node.host = host_->text().trimmed().toStdString();
  s.node.port = port_->value();
  s.node.calledTitle = called_->text().trimmed().toStdString();
  s.node.callingTitle = calling_->text().trimmed().toStdString();
  s.move = move_->isChecked();
  s.receivePort = receivePort_->value();
  return s;
}

void PacsDialog::keepServer() {
  const int index = names_->currentIndex();
  if (filling_ || index < 0) return;
  servers_[static_cast<std::size_t>(index)] = server();
  filling_ = true;
  names_->setItemText(index, servers_[static_cast<std::size_t>(index)].name);
  filling_ = false;
  session::keepServers(servers_);
  refresh();
}

void PacsDialog::addServer() {
  servers_.push_back({tr("Server %1").arg(servers_.size() + 1), {}, false, 11112});
  filling_ = true;
  names_->addItem(servers_.back().name);
  filling_ = false;
  showServer(static_cast<int>(servers_.size()) - 1);
  session::keepServers(servers_);
  host_->setFocus();
}

void PacsDialog::removeServer() {
  if (servers_.size() < 2) return;
  const int index = std::max(names_->currentIndex(), 0);
  servers_.erase(servers_.begin() + index);
  filling_ = true;
  names_->removeItem(index);
  filling_ = false;
  showServer(std::min(index, static_cast<int>(servers_.size()) - 1));
  session::keepServers(servers_);
}

void PacsDialog::say(const QString& text, bool bad) {
  said_->setText(bad && !text.isEmpty() ? QStringLiteral("⚠ ") + text : text);
}

void PacsDialog::echo() {
  auto seconds = std::make_shared<double>(0.0);
  work(
      tr("Asking"),
      [seconds, node = server().node](const Progress& progress) { *seconds = pacs::echo(node, progress); },
      [this, seconds](const QString& reason) {
        if (reason.isEmpty())
          say(tr("The server answers after %1 ms.").arg(1000.0 * *seconds, 0, 'f', 0));
        else
          say(sentence(reason), true);
      });
}

void PacsDialog::refresh() {
  if (!send_) return;  // still being made
  remove_->setEnabled(servers_.size() > 1);
  receivePort_->setEnabled(move_->isChecked());
  const bool free = !busy() && !host_->text().trimmed().isEmpty();
  find_->setEnabled(free);
  fetch_->setEnabled(free && !chosen().empty() && !folder_->text().trimmed().isEmpty());
  open_->setVisible(!fetched_.isEmpty());
  bool any = files_->count() > 0;
  for (const auto& [offer, tick] : ticks_) any = any || (tick->isEnabled() && tick->isChecked());
  send_->setEnabled(free && any);
}

bool PacsDialog::event(QEvent* event) {
  // What is shown in the window may have changed while the hand was there.
  if (event->type() == QEvent::Show || event->type() == QEvent::WindowActivate) refreshTicks();
  return WorkDialog::event(event);
}

}  // namespace glisson::panels
