//! The elements behind the header, in the order in which it names them.

use std::collections::BTreeSet;

use glam::DVec3;

use super::super::Dropped;
use super::super::fault::Fault;
use super::super::soup::Soup;
use super::header::{Element, Header, Property};
use super::rows::{Rows, Trouble};

/// Reads all elements.
pub(super) fn read<R: Rows>(header: &Header, mut rows: R) -> Result<Soup, Fault> {
    let mut soup = Soup { dropped: dropped(header), ..Soup::default() };
    let vertex_count = header.elements.iter().find(|e| e.name == "vertex").map_or(0, |e| e.rows);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(&mut rows, element, &mut soup)?,
            "face" => read_polygons(&mut rows, element, vertex_count, &mut soup)?,
            "tristrips" => read_strips(&mut rows, element, vertex_count, &mut soup)?,
            _ => each_row(&mut rows, element, |rows, _| skip_row(rows, &element.properties))?,
        }
    }
    if rows.has_surplus() {
        soup.dropped.insert(Dropped::OtherProperties);
    }
    if rows.is_at_end() {
        Ok(soup)
    } else {
        Err(rows.fault("the file goes on behind all that the header promises; its counts are wrong".to_owned()))
    }
}

/// Calls `read` for each row of the element, with the row's number.
fn each_row<R: Rows>(
    rows: &mut R,
    element: &Element,
    mut read: impl FnMut(&mut R, usize) -> Result<(), Trouble>,
) -> Result<(), Fault> {
    if element.properties.is_empty() {
        return Ok(()); // Its rows take no bytes, however many are promised.
    }
    for row in 0..element.rows {
        match read(rows, row).and_then(|()| rows.end_row()) {
            Ok(()) => {}
            Err(Trouble::Wrong(fault)) => return Err(fault),
            Err(Trouble::End) => return Err(rows.truncated(&format!("{} {}", element.rows, element.noun()), row)),
        }
    }
    Ok(())
}

fn skip_row<R: Rows>(rows: &mut R, properties: &[Property]) -> Result<(), Trouble> {
    properties.iter().try_for_each(|p| skip_property(rows, p))
}

#[inline]
fn skip_property<R: Rows>(rows: &mut R, property: &Property) -> Result<(), Trouble> {
    let count = match property.count {
        None => 1,
        Some(kind) => list_length(rows, kind)?,
    };
    rows.skip(property.kind, count)
}

#[inline]
fn list_length<R: Rows>(rows: &mut R, kind: super::header::Scalar) -> Result<u64, Trouble> {
    let count = rows.integer(kind)?;
    u64::try_from(count).map_err(|_| rows.fault(format!("a list cannot have {count} items")).into())
}

fn read_vertices<R: Rows>(rows: &mut R, element: &Element, soup: &mut Soup) -> Result<(), Fault> {
    const AXES: [&str; 3] = ["x", "y", "z"];
    for axis in AXES {
        if !element.properties.iter().any(|p| p.name == axis && p.count.is_none()) {
            return Err(Fault::new(format!("the header gives vertices no property {axis}")));
        }
    }
    let axes: Vec<Option<usize>> =
        element.properties.iter().map(|p| AXES.iter().position(|&a| p.count.is_none() && p.name == a)).collect();
    soup.positions.reserve_exact(element.rows.min(rows.most_rows(element)));
    each_row(rows, element, |rows, _| {
        let mut position = DVec3::ZERO;
        for (property, axis) in element.properties.iter().zip(&axes) {
            match axis {
                Some(axis) => position[*axis] = rows.float(property.kind)?,
                None => skip_property(rows, property)?,
            }
        }
        soup.positions.push(position);
        Ok(())
    })
}

/// Which property of the element lists vertices.
fn index_list(element: &Element) -> Result<Option<usize>, Fault> {
    let is_list = |p: &Property| p.count.is_some() && matches!(p.name.as_str(), "vertex_indices" | "vertex_index");
    match element.properties.iter().position(is_list) {
        None if element.rows == 0 => Ok(None),
        None => Err(Fault::new(format!("the header gives {} no list vertex_indices", element.noun()))),
        Some(list) if element.properties[list].kind.is_integer() => Ok(Some(list)),
        Some(_) => Err(Fault::new("the list vertex_indices must have an integer type")),
    }
}

/// Reads the rows of an element that lists vertices, handing on each list: in range, or `None` for -1 if allowed.
fn each_list<R: Rows>(
    rows: &mut R,
    element: &Element,
    check: impl Fn(i64, usize) -> Result<u32, String>,
    mut take: impl FnMut(&[u32]) -> Result<(), String>,
) -> Result<(), Fault> {
    let Some(list) = index_list(element)? else { return Ok(()) };
    let mut indices = Vec::new();
    each_row(rows, element, |rows, row| {
        indices.clear();
        for (i, property) in element.properties.iter().enumerate() {
            let Some(count) = property.count.filter(|_| i == list) else {
                skip_property(rows, property)?;
                continue;
            };
            for _ in 0..list_length(rows, count)? {
                let index = rows.integer(property.kind)?;
                indices.push(check(index, row).map_err(|message| rows.fault(message))?);
            }
        }
        take(&indices).map_err(|message| rows.fault(message).into())
    })
}

fn read_polygons<R: Rows>(rows: &mut R, element: &Element, vertices: usize, soup: &mut Soup) -> Result<(), Fault> {
    // A triangle takes more bytes than an empty list, so this may be too much, but in proportion to the file.
    soup.polygons.reserve(element.rows.min(rows.most_rows(element) / if element.has_lists() { 4 } else { 1 }));
    let Soup { polygons, dropped, .. } = soup;
    each_list(
        rows,
        element,
        |index, row| in_range(index, vertices).ok_or_else(|| out_of_range("triangle", row, index, vertices)),
        |corners| {
            if !polygons.push(corners)? {
                dropped.insert(Dropped::PointsAndLines);
            }
            Ok(())
        },
    )
}

/// Ends a strip; the next index begins another.
const RESTART: u32 = u32::MAX;

/// Triangle strips: every index makes a triangle with the two before it, every other one turned; -1 restarts.
fn read_strips<R: Rows>(rows: &mut R, element: &Element, vertices: usize, soup: &mut Soup) -> Result<(), Fault> {
    let polygons = &mut soup.polygons;
    each_list(
        rows,
        element,
        |index, row| match index {
            -1 => Ok(RESTART),
            _ => in_range(index, vertices).ok_or_else(|| out_of_range("triangle strip", row, index, vertices)),
        },
        |indices| {
            for strip in indices.split(|&i| i == RESTART) {
                for (i, corners) in strip.windows(3).enumerate() {
                    let (a, b, c) = (corners[0], corners[1], corners[2]);
                    polygons.push_triangle(if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
                }
            }
            Ok(())
        },
    )
}

#[inline]
fn in_range(index: i64, vertices: usize) -> Option<u32> {
    u32::try_from(index).ok().filter(|&i| (i as usize) < vertices && i != RESTART)
}

fn out_of_range(noun: &str, row: usize, index: i64, vertices: usize) -> String {
    format!("{noun} {row} uses vertex {index}, but the file has {vertices} vertices (counted from 0)")
}

/// What the header names beyond coordinates and triangles.
fn dropped(header: &Header) -> BTreeSet<Dropped> {
    let mut dropped = BTreeSet::new();
    if header.names_texture {
        dropped.insert(Dropped::Materials);
    }
    for element in header.elements.iter().filter(|e| e.rows > 0) {
        match element.name.as_str() {
            "vertex" | "face" | "tristrips" => dropped.extend(element.properties.iter().filter_map(dropped_property)),
            "edge" | "line" | "polyline" => _ = dropped.insert(Dropped::PointsAndLines),
            "material" => _ = dropped.insert(Dropped::Materials),
            _ => _ = dropped.insert(Dropped::OtherProperties),
        }
    }
    dropped
}

fn dropped_property(property: &Property) -> Option<Dropped> {
    Some(match property.name.as_str() {
        "x" | "y" | "z" | "vertex_indices" | "vertex_index" => return None,
        "nx" | "ny" | "nz" => Dropped::Normals,
        "s" | "t" | "u" | "v" | "texcoord" | "texture_u" | "texture_v" | "texture_w" => Dropped::TextureCoordinates,
        "texnumber" | "material_index" => Dropped::Materials,
        "red" | "green" | "blue" | "alpha" | "r" | "g" | "b" | "a" => Dropped::Colours,
        name if name.starts_with("diffuse_") || name.starts_with("ambient_") || name.starts_with("specular_") => {
            Dropped::Colours
        }
        _ => Dropped::OtherProperties,
    })
}
