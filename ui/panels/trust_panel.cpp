// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/trust_panel.h"

#include <QEvent>
#include <set>

#include "panels/form.h"
#include "session/session.h"
#include "session/trust.h"

namespace glisson::panels {

using session::Remedy;

namespace {

/// Each severity has a sign of its own: colour is never the only one.
QString marked(Severity severity, const QString& text) {
  const QString words = text.toHtmlEscaped();
  if (severity == Severity::Note) return words;
  const QColor colour = severity == Severity::Error ? bad() : caution();
  const QString sign = severity == Severity::Error ? QStringLiteral("✕") : QStringLiteral("▲");
  return QStringLiteral("<span style=\"color:%1\">%2&nbsp;%3</span>").arg(colour.name(), sign, words);
}

/// What the button of a remedy says: what it changes.
QString textOf(Remedy remedy, const session::Parameters& after) {
  switch (remedy) {
    case Remedy::LargeDeformation: return TrustPanel::tr("Run in large deformation");
    case Remedy::SmallerCells: return TrustPanel::tr("Halve the cells and run");
    case Remedy::BorneForce: return TrustPanel::tr("Ask for %1 N and run").arg(after.force_N, 0, 'f', 1);
    case Remedy::FoundPlace: return TrustPanel::tr("Find a place and run");
    case Remedy::None: break;
  }
  return {};
}

QString tipOf(Remedy remedy, const session::Parameters& before, const session::Parameters& after) {
  switch (remedy) {
    case Remedy::LargeDeformation:
      return TrustPanel::tr("Kinematics: hyperelastic, on voxel hexahedra at rest. It takes some minutes.");
    case Remedy::SmallerCells:
      return session::isDelaunay(after.method)
                 ? TrustPanel::tr("Tetrahedra of %1 mm: about eight times the run time")
                       .arg(after.tetEdge_mm, 0, 'f', 1)
                 : TrustPanel::tr("Cells of %1 mm: about eight times the run time").arg(after.cell_mm, 0, 'f', 2);
    case Remedy::BorneForce: return TrustPanel::tr("Nine tenths of what both livers bore at this place");
    case Remedy::FoundPlace:
      return before.placement.barAt_lps ? TrustPanel::tr("In place of where the bar was laid by hand") : QString();
    case Remedy::None: break;
  }
  return {};
}

}  // namespace

TrustPanel::TrustPanel(session::Session& session, const QString& textName, QWidget* parent)
    : QWidget(parent), session_(session) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  words_ = labelled({}, "text");
  words_->setObjectName(textName);
  words_->setTextFormat(Qt::RichText);
  words_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(words_);
  remedies_ = new QVBoxLayout;
  remedies_->setSpacing(6);
  column->addLayout(remedies_);
}

QString TrustPanel::outdated(const session::Session& session) {
  const session::ChangedSince changed = session.changedSinceRun();
  if (changed.outlines && changed.parameters)
    return tr("Results of earlier outlines and other parameters, not of those shown now");
  if (changed.outlines) return tr("Results of earlier outlines, not of those shown now");
  if (changed.parameters) return tr("Results of other parameters, not of those set now");
  return changed.before ? tr("Results of an earlier state of this case, not of what is shown now") : QString();
}

void TrustPanel::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) show_();  // the colours are those of the theme
  QWidget::changeEvent(event);
}

QString TrustPanel::sizeOfCells() const {
  const auto result = session_.result();
  if (!result->discretisation) return {};
  const retraction::DiscretisationError& e = *result->discretisation;
  if (!e.known) {
    QString why = QString::fromStdString(e.note);
    if (const QString said = QStringLiteral("discretisation error unknown: "); why.startsWith(said))
      why.remove(0, said.size());
    return tr("How much the size of the cells matters is not known: %1").arg(withStop(why));
  }
  QString words =
      tr("The cells of %1 mm may shift a place by %2 mm on average, and by no more than %3 mm in 95 % of the "
         "liver (estimated from cells twice as large).")
          .arg(e.cell_mm, 0, 'f', 1)
          .arg(e.mean_mm, 0, 'f', 2)
          .arg(e.p95_mm, 0, 'f', 2);
  if (e.difference && result->difference && result->difference->mean_mm > 0.0) {
    words +=
        QLatin1Char(' ') + tr("Most of it is common to both answers: the difference shown errs by %1 mm on average.")
                               .arg(e.difference->mean_mm, 0, 'f', 2);
    if (e.difference->mean_mm > 0.5 * result->difference->mean_mm)
      words +=
          QLatin1Char(' ') + tr("That is more than half of the mean difference: use smaller cells before concluding.");
  }
  return words;
}

void TrustPanel::offer(Remedy remedy) {
  const auto after = session::remedied(remedy, session_.parameters(), *session_.result());
  if (!after) return;
  QPushButton* doIt = button(("remedy" + std::to_string(static_cast<int>(remedy))).c_str(), textOf(remedy, *after),
                             QStringLiteral("run"), tipOf(remedy, session_.parameters(), *after));
  doIt->setIcon(icon(QStringLiteral("run")));
  doIt->setEnabled(!session_.busy());
  connect(&session_, &session::Session::statusChanged, doIt, [this, doIt] { doIt->setEnabled(!session_.busy()); });
  connect(doIt, &QPushButton::clicked, this, [this, remedy] {
    const auto wanted = session::remedied(remedy, session_.parameters(), *session_.result());
    if (!wanted) return;
    session_.setParameters(*wanted);
    emit runWanted();
  });
  remedies_->addWidget(doIt);
}

void TrustPanel::takeOffers() {
  while (QLayoutItem* item = remedies_->takeAt(0)) {
    if (item->widget()) item->widget()->deleteLater();
    delete item;
  }
}

void TrustPanel::show_() {
  takeOffers();
  const auto result = session_.result();
  if (!result) {
    words_->setText(tr("Not run yet."));
    return;
  }
  QStringList paragraphs;
  std::set<Remedy> offered;
  bool doubtful = false;
  QString before;
  const QString faint = palette().color(QPalette::PlaceholderText).name();
  for (const session::Doubt& d : session::doubtsAbout(*result)) {
    doubtful = doubtful || d.severity != Severity::Note;
    QString words = marked(d.severity, sentence(d.text));
    // The same advice stands once, under the last that asks for it.
    if (!d.advice.isEmpty() && d.advice == before) paragraphs.back().truncate(paragraphs.back().indexOf("<br>"));
    if (!d.advice.isEmpty())
      words += QStringLiteral("<br><span style=\"color:%1\">→&nbsp;%2</span>").arg(faint, d.advice.toHtmlEscaped());
    paragraphs << words;
    before = d.advice;
    if (d.remedy != Remedy::None && d.severity != Severity::Note) offered.insert(d.remedy);
  }
  if (!doubtful)
    paragraphs.prepend((result->primary.kinematics == retraction::Kinematics::Linear
                            ? tr("No warning: strains and rotations of both answers are within linear theory.")
                            : tr("No warning: the large deformation of both answers converged."))
                           .toHtmlEscaped());
  if (const QString cells = sizeOfCells(); !cells.isEmpty()) paragraphs << cells.toHtmlEscaped();
  words_->setText(QStringLiteral("<p style=\"margin:0 0 6px 0\">") +
                  paragraphs.join(QStringLiteral("</p><p style=\"margin:0 0 6px 0\">")) + QStringLiteral("</p>"));
  for (const Remedy remedy : offered) offer(remedy);
}

}  // namespace glisson::panels
