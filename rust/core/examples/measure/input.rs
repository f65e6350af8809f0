//! What is measured: a folder of raw little-endian numbers, and words on the command line.

use std::collections::HashMap;
use std::error::Error;
use std::path::{Path, PathBuf};

use ridgeform_core::linear::Columns;
use ridgeform_core::mesh::Mesh;
use sprs::{CsMat, TriMat};

/// `KIND FOLDER [KEY=VALUE ...]`.
pub(crate) struct Arguments {
    /// What to measure.
    pub kind: String,
    /// Where the problem is.
    pub folder: PathBuf,
    settings: HashMap<String, String>,
}

impl Arguments {
    /// Splits the command line.
    pub(crate) fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let (Some(kind), Some(folder)) = (words.next(), words.next()) else {
            return Err("usage: measure KIND FOLDER [KEY=VALUE ...]".into());
        };
        let mut settings = HashMap::new();
        for word in words {
            let (key, value) = word.split_once('=').ok_or_else(|| format!("{word} is not KEY=VALUE"))?;
            settings.insert(key.to_string(), value.to_string());
        }
        Ok(Self { kind, folder: folder.into(), settings })
    }

    /// The word given for `key`.
    pub(crate) fn word<'a>(&'a self, key: &str, default: &'a str) -> &'a str {
        self.settings.get(key).map_or(default, String::as_str)
    }

    /// The number given for `key`.
    pub(crate) fn number(&self, key: &str, default: f64) -> Result<f64, Box<dyn Error>> {
        self.settings.get(key).map_or(Ok(default), |word| Ok(word.parse()?))
    }
}

/// `A` and `b` of `A u = b`.
type Equations = (CsMat<f64>, Columns);

/// A mesh and data on it.
pub(crate) struct Problem {
    /// `vertices.f64`.
    pub vertices: Vec<[f64; 3]>,
    /// `faces.u32`.
    pub faces: Vec<[u32; 3]>,
    folder: PathBuf,
}

impl Problem {
    /// Reads the mesh.
    pub(crate) fn read(folder: &Path) -> Result<Self, Box<dyn Error>> {
        let vertices = doubles(&folder.join("vertices.f64"))?;
        let faces = integers(&folder.join("faces.u32"))?;
        Ok(Self {
            vertices: vertices.as_chunks().0.to_vec(),
            faces: faces.as_chunks().0.to_vec(),
            folder: folder.to_path_buf(),
        })
    }

    /// The mesh with its connectivity.
    pub(crate) fn mesh(&self) -> Result<Mesh, Box<dyn Error>> {
        Ok(Mesh::new(self.vertices.clone(), self.faces.clone())?)
    }

    /// `values.f64`: a number per vertex, column by column.
    pub(crate) fn values(&self) -> Result<Columns, Box<dyn Error>> {
        let data = doubles(&self.folder.join("values.f64"))?;
        let n_rows = self.vertices.len();
        Ok(Columns { n_rows, n_columns: data.len() / n_rows.max(1), data })
    }

    /// `indices.u32`: the vertices whose values are known, and those values.
    pub(crate) fn known(&self) -> Result<(Vec<usize>, Columns), Box<dyn Error>> {
        let indices = self.places("indices.u32")?;
        let values = self.values()?;
        let mut known = Columns::zeros(indices.len(), values.n_columns);
        for c in 0..values.n_columns {
            for (x, &i) in known.column_mut(c).iter_mut().zip(&indices) {
                *x = values.column(c)[i];
            }
        }
        Ok((indices, known))
    }

    /// `weights.f64`, if there is one: a weight per face.
    pub(crate) fn face_weights(&self) -> Result<Option<Vec<f64>>, Box<dyn Error>> {
        let path = self.folder.join("weights.f64");
        Ok(if path.exists() { Some(doubles(&path)?) } else { None })
    }

    /// `constraint_*`, if there are any: the entries of `A` by row, column and value, and `b`,
    /// for one column of values.
    pub(crate) fn linear_constraints(&self) -> Result<Option<Equations>, Box<dyn Error>> {
        if !self.folder.join("constraint_rows.u32").exists() {
            return Ok(None);
        }
        let (rows, columns) = (self.places("constraint_rows.u32")?, self.places("constraint_columns.u32")?);
        let entries = doubles(&self.folder.join("constraint_values.f64"))?;
        let right = doubles(&self.folder.join("constraint_right.f64"))?;
        let matrix = TriMat::from_triplets((right.len(), self.vertices.len()), rows, columns, entries);
        Ok(Some((matrix.to_csr(), Columns::from_column(right))))
    }

    fn places(&self, name: &str) -> Result<Vec<usize>, Box<dyn Error>> {
        Ok(integers(&self.folder.join(name))?.into_iter().map(|i| i as usize).collect())
    }
}

fn doubles(path: &Path) -> Result<Vec<f64>, Box<dyn Error>> {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(bytes.as_chunks().0.iter().map(|&b| f64::from_le_bytes(b)).collect())
}

fn integers(path: &Path) -> Result<Vec<u32>, Box<dyn Error>> {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(bytes.as_chunks().0.iter().map(|&b| u32::from_le_bytes(b)).collect())
}
