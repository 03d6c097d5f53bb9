//! Input decks of CalculiX and Abaqus.

mod boundary;
mod card;
mod conditions;
mod contact;
mod equation;
mod finish;
mod material;
mod mesh;
mod model;
mod refused;
mod steps;
mod transform;

use crate::deck::Deck;
use crate::{ImportError, What};
use model::Model;
use std::path::Path;

/// Reads a deck.
pub(crate) fn read(file: &Path, what: What) -> Result<Deck, ImportError> {
    let cards = card::cards(file)?;
    let mut deck = Deck { file: file.to_path_buf(), ..Deck::default() };
    for card in &cards {
        mesh::read(card, &mut deck, what)?;
    }
    // Sets may stand behind the surfaces that are made of them.
    for card in cards.iter().filter(|card| card.name() == "SURFACE") {
        mesh::surface(card, &mut deck)?;
    }
    if what == What::Mesh {
        return Ok(deck);
    }
    let mut model = Model::new(deck);
    for card in &cards {
        model.read(card)?;
    }
    model.finish()
}
