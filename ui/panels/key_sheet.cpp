// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/key_sheet.h"

#include <QAction>
#include <QCoreApplication>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QStyledItemDelegate>
#include <QTabWidget>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "panels/form.h"
#include "panels/keys.h"
#include "panels/step_rail.h"

namespace glisson::panels {

namespace {

/// Rows as high as their texts need in columns as wide as they are; a tree by itself makes room for one line.
class WholeTexts : public QStyledItemDelegate {
 public:
  explicit WholeTexts(QTreeWidget* tree) : QStyledItemDelegate(tree), tree_(tree) {
    connect(tree->header(), &QHeaderView::sectionResized, this, [this] { emit sizeHintChanged({}); });
  }
  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    constexpr int margin = 18, air = 12;  // what the style sheet and the style put around a text
    const QRect room(0, 0, std::max(tree_->columnWidth(index.column()) - margin, 40), 10000);
    const QRect text = option.fontMetrics.boundingRect(room, Qt::TextWordWrap, index.data().toString());
    return {option.fontMetrics.horizontalAdvance(index.data().toString()) + margin, text.height() + air};
  }

 private:
  QTreeWidget* tree_;
};

QTreeWidget* tree(const char* name, const QStringList& columns) {
  auto* t = new QTreeWidget;
  t->setObjectName(QString::fromLatin1(name));
  t->setHeaderLabels(columns);
  t->setRootIsDecorated(false);
  t->setAlternatingRowColors(true);
  t->setWordWrap(true);
  t->header()->setStretchLastSection(false);
  t->setItemDelegate(new WholeTexts(t));
  return t;
}

QString translated(const char* text) {
  return *text ? QCoreApplication::translate("keymap", text) : QStringLiteral("–");
}

}  // namespace

KeySheet::KeySheet(Keys& keys, QWidget* parent) : QDialog(parent), keys_(keys) {
  setWindowTitle(tr("Keys and mouse"));
  setObjectName(QStringLiteral("keySheet"));
  resize(820, 720);
  auto* layout = new QVBoxLayout(this);
  auto* tabs = new QTabWidget;
  layout->addWidget(tabs);
  table_ = tree("keyTable", {tr("What"), tr("Key"), tr("Group")});
  table_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
  tabs->addTab(table_, tr("Keys"));
  auto* mouse = tree("gestureTable", {tr("Mouse"), tr("Idle"), tr("Drawing"), tr("Editing, accepted")});
  mouse->header()->setSectionResizeMode(QHeaderView::Stretch);
  for (const tools::GestureEntry& g : tools::gestureTable())
    new QTreeWidgetItem(mouse,
                        {translated(g.gesture), translated(g.idle), translated(g.drawing), translated(g.editing)});
  tabs->addTab(mouse, tr("Mouse"));
  auto* scene = tree("sceneTable", {tr("3-D views and pictures"), tr("Mouse"), tr("Keys")});
  scene->header()->setSectionResizeMode(QHeaderView::Stretch);
  for (const tools::SceneEntry& e : tools::sceneTable())
    new QTreeWidgetItem(scene, {translated(e.what), translated(e.mouse), translated(e.keys)});
  tabs->addTab(scene, tr("3-D"));
  menus_ = tree("menuKeyTable", {tr("What"), tr("Key")});
  menus_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  menus_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
  tabs->addTab(menus_, tr("Steps and menus"));
  layout->addWidget(
      labelled(tr("Double-click a key to change it. Keys work while the mouse is over an image."), "faint"));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  QPushButton* reset = buttons->addButton(tr("As shipped"), QDialogButtonBox::ResetRole);
  layout->addWidget(buttons);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(reset, &QPushButton::clicked, &keys_, &Keys::reset);
  connect(&keys_, &Keys::changed, this, &KeySheet::fill);
  connect(table_, &QTreeWidget::itemActivated, this,
          [this](QTreeWidgetItem* item) { change(item->data(0, Qt::UserRole).toInt()); });
  fill();
}

void KeySheet::fill() {
  table_->clear();
  for (const tools::KeyEntry& e : tools::keyTable()) {
    QStringList keys;
    for (const QKeySequence& k : keys_.of(e.command)) keys << k.toString(QKeySequence::NativeText);
    auto* item = new QTreeWidgetItem(table_, {nameOf(e.command), keys.join(QStringLiteral(", ")), translated(e.group)});
    item->setData(0, Qt::UserRole, static_cast<int>(e.command));
  }
}

// Keys of the window itself: they act wherever the mouse is, and are not changed here.
void KeySheet::fillMenus() {
  menus_->clear();
  if (!parentWidget()) return;
  const auto add = [this](const QString& what, const QKeySequence& key) {
    new QTreeWidgetItem(menus_, {what, key.toString(QKeySequence::NativeText)});
  };
  for (const StepButton* step : parentWidget()->findChildren<StepButton*>())
    add(tr("Step %1").arg(step->text()), step->shortcut());
  for (const QAction* action : parentWidget()->findChildren<QAction*>()) {
    const bool listed = std::any_of(tools::keyTable().begin(), tools::keyTable().end(),
                                    [&](const auto& e) { return keys_.of(e.command).contains(action->shortcut()); });
    if (!action->shortcut().isEmpty() && !listed) add(action->text().remove(QLatin1Char('&')), action->shortcut());
  }
}

void KeySheet::showEvent(QShowEvent* event) {
  fillMenus();
  QDialog::showEvent(event);
}

void KeySheet::change(int command) {
  const auto wanted = static_cast<tools::Command>(command);
  QDialog dialog(this);
  dialog.setWindowTitle(nameOf(wanted));
  auto* layout = new QVBoxLayout(&dialog);
  layout->addWidget(new QLabel(tr("Press the new key:")));
  auto* edit = new QKeySequenceEdit;
  layout->addWidget(edit);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  layout->addWidget(buttons);
  connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  edit->setFocus();
  if (dialog.exec() != QDialog::Accepted || edit->keySequence().isEmpty()) return;
  if (const auto taken = keys_.set(wanted, QKeySequence(edit->keySequence()[0])))
    QMessageBox::information(this, windowTitle(), tr("This key already means: %1").arg(nameOf(*taken)));
}

}  // namespace glisson::panels
