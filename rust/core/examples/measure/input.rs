//! What is measured: a folder of raw little-endian numbers, and words on the command line.

use std::collections::HashMap;
use std::error::Error;
use std::path::{Path, PathBuf};

use ridgeform_core::mesh::Mesh;
use ridgeform_core::solve::Columns;

/// `KIND FOLDER [KEY=VALUE ...]`.
pub struct Arguments {
    /// What to measure.
    pub kind: String,
    /// Where the problem is.
    pub folder: PathBuf,
    settings: HashMap<String, String>,
}

impl Arguments {
    /// Splits the command line.
    pub fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
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
    pub fn word<'a>(&'a self, key: &str, default: &'a str) -> &'a str {
        self.settings.get(key).map_or(default, String::as_str)
    }

    /// The number given for `key`.
    pub fn number(&self, key: &str, default: f64) -> Result<f64, Box<dyn Error>> {
        self.settings.get(key).map_or(Ok(default), |word| Ok(word.parse()?))
    }
}

/// A mesh and data on it.
pub struct Problem {
    /// `vertices.f64`.
    pub vertices: Vec<[f64; 3]>,
    /// `faces.u32`.
    pub faces: Vec<[u32; 3]>,
    folder: PathBuf,
}

impl Problem {
    /// Reads the mesh.
    pub fn read(folder: &Path) -> Result<Self, Box<dyn Error>> {
        let vertices = doubles(&folder.join("vertices.f64"))?;
        let faces = integers(&folder.join("faces.u32"))?;
        Ok(Self {
            vertices: vertices.as_chunks().0.to_vec(),
            faces: faces.as_chunks().0.to_vec(),
            folder: folder.to_path_buf(),
        })
    }

    /// The mesh with its connectivity.
    pub fn mesh(&self) -> Result<Mesh, Box<dyn Error>> {
        Ok(Mesh::new(self.vertices.clone(), self.faces.clone())?)
    }

    /// `values.f64`: one number per vertex.
    pub fn values(&self) -> Result<Columns, Box<dyn Error>> {
        Ok(Columns::from_column(doubles(&self.folder.join("values.f64"))?))
    }

    /// `indices.u32`: the vertices whose values are known, and those values.
    pub fn known(&self) -> Result<(Vec<usize>, Columns), Box<dyn Error>> {
        let indices: Vec<usize> = integers(&self.folder.join("indices.u32"))?.into_iter().map(|i| i as usize).collect();
        let values = self.values()?;
        let known = indices.iter().map(|&i| values.data[i]).collect();
        Ok((indices, Columns::from_column(known)))
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
