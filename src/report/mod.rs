//! What people look at: colour maps, pictures with text, contact sheets and plain tables.
//!
//! Pictures are made from plain arrays of grey levels or colours; nothing here knows where they came from.

mod font;

pub mod colour;
pub mod contact_sheet;
pub mod diagram;
pub mod histogram;
pub mod legend;
pub mod outline;
pub mod page;
pub mod paper;
pub mod picture;
pub mod plot;
pub mod rank;
pub mod table;
