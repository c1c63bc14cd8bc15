//! Variables of a file that somebody wrote: netCDF classic in its three variants and netCDF-4 (HDF5), which `netcdf-reader` takes apart.
//! What a variable promises is judged before memory is asked for; links and data that lie in other files are not followed.

use super::value::text;
use crate::read::source::room;
#[cfg(test)]
use netcdf_reader::NcAttrValue;
use netcdf_reader::{Error, NcFile, NcFormat, NcOpenOptions, NcType, NcVariable};
use peridyne::error::size;

/// A file at hand.
pub struct Reader {
    file: NcFile,
    /// Most bytes that a variable of numbers can have, and one of texts.
    most: [u64; 2],
}

/// Times that netCDF-4 makes numbers shorter at most: deflate does not do better.
const SHRUNK: u64 = 1032;
/// Bytes of texts that a netCDF-4 file can have, however small it is.
const TEXTS: u64 = 1 << 24;
/// The dimension of frames in Exodus: what varies along it is a result.
const TIME: &str = "time_step";

impl Reader {
    /// # Errors
    /// What is wrong with the header, in words.
    pub fn new(bytes: Vec<u8>) -> Result<Self, String> {
        let length = bytes.len() as u64;
        let shrunk = length.saturating_mul(SHRUNK);
        let options = NcOpenOptions {
            // each is read once
            chunk_cache_bytes: 0,
            max_read_bytes: usize::try_from(shrunk).unwrap_or(usize::MAX),
            max_chunk_bytes: usize::try_from(shrunk).unwrap_or(usize::MAX),
            ..NcOpenOptions::default()
        };
        let file = NcFile::from_owner(bytes, options).map_err(told)?;
        let most = match file.format() {
            NcFormat::Classic | NcFormat::Offset64 | NcFormat::Cdf5 => [length, length],
            NcFormat::Nc4 | NcFormat::Nc4Classic => [shrunk, shrunk.min(TEXTS)],
        };
        // all that stands before the numbers, so that what is damaged is not taken for what is not there
        file.dimensions().and(file.variables()).map_err(told)?;
        Ok(Reader { file, most })
    }

    /// All variables.
    fn variables(&self) -> &[NcVariable] {
        self.file.variables().unwrap_or_default()
    }

    /// How many variables there are.
    pub fn count(&self) -> usize {
        self.variables().len()
    }

    fn find(&self, name: &str) -> Option<&NcVariable> {
        self.variables().iter().find(|v| v.name == name)
    }

    /// The length of a dimension.
    pub fn length(&self, dimension: &str) -> Option<u64> {
        let mut all = self.file.dimensions().unwrap_or_default().iter();
        all.find(|d| d.name == dimension).map(|d| d.size)
    }

    /// The lengths of a variable.
    pub fn shape(&self, name: &str) -> Option<Vec<u64>> {
        self.find(name).map(NcVariable::shape)
    }

    /// A text that belongs to a variable.
    pub fn attribute(&self, name: &str, attribute: &str) -> Option<String> {
        let value = &self.find(name)?.attribute(attribute)?.value;
        value.as_string().map(|t| text(t.as_bytes()))
    }

    /// A variable that can be read; `None`: there is none, or it has no numbers.
    fn judged(&self, name: &str, most: u64) -> Result<Option<&NcVariable>, String> {
        let Some(v) = self.find(name).filter(|v| !v.shape().contains(&0)) else {
            return Ok(None);
        };
        if v.dimensions.len() > 1 && v.dimensions[0].name == TIME {
            return Err(format!(
                "{name} should have one value, not one of each frame"
            ));
        }
        let bytes = v.dtype.size().ok().and_then(|each| {
            let mut lengths = v.dimensions.iter().map(|d| d.size);
            lengths.try_fold(each as u64, u64::checked_mul)
        });
        match bytes.filter(|bytes| *bytes <= most) {
            None => Err(format!(
                "the file is cut short or damaged: {name} would have {}, more than a file of this size can hold",
                bytes.map_or("more than can be counted".into(), |b| size(b as f64))
            )),
            Some(bytes) => {
                // as it is stored, and as it is used
                room(name, 3.0 * bytes as f64).map_err(|e| e.to_string())?;
                Ok(Some(v))
            }
        }
    }

    /// Numbers with a point; `None`: there is no such variable.
    ///
    /// # Errors
    /// It is of another type, has more than one value in time, or the file is cut short or damaged.
    pub fn floats(&self, name: &str) -> Result<Option<Vec<f64>>, String> {
        let Some(v) = self.judged(name, self.most[0])? else {
            return Ok(self.find(name).map(|_| vec![]));
        };
        if !matches!(v.dtype, NcType::Float | NcType::Double) {
            return Err(other(v, "numbers with a point"));
        }
        let all = self.file.read_variable_as_f64(name).map_err(told)?;
        Ok(Some(all.into_iter().collect()))
    }

    /// Whole numbers, likewise.
    pub fn wholes(&self, name: &str) -> Result<Option<Vec<i64>>, String> {
        let Some(v) = self.judged(name, self.most[0])? else {
            return Ok(self.find(name).map(|_| vec![]));
        };
        /// Values of this type as whole numbers.
        macro_rules! of {
            ($kind:ty) => {{
                self.file
                    .read_variable::<$kind>(name)
                    .map_err(told)?
                    .into_iter()
            }
            .map(|n| i64::try_from(n).ok())
            .collect()};
        }
        let all: Option<Vec<i64>> = match v.dtype {
            NcType::Byte => of!(i8),
            NcType::UByte => of!(u8),
            NcType::Short => of!(i16),
            NcType::UShort => of!(u16),
            NcType::Int => of!(i32),
            NcType::UInt => of!(u32),
            NcType::Int64 => of!(i64),
            NcType::UInt64 => of!(u64),
            NcType::Char
            | NcType::Float
            | NcType::Double
            | NcType::String
            | NcType::Enum { .. }
            | NcType::Compound { .. }
            | NcType::Opaque { .. }
            | NcType::Array { .. }
            | NcType::VLen { .. } => return Err(other(v, "whole numbers")),
        };
        let large = || format!("{name} has a number that is larger than 2^63");
        all.map(Some).ok_or_else(large)
    }

    /// Numbers of one frame (from 0): only tests look into results.
    #[cfg(test)]
    pub fn record(&self, name: &str, record: usize) -> Vec<f64> {
        let all = self.file.read_variable_as_f64(name).unwrap();
        all.outer_iter()
            .nth(record)
            .unwrap()
            .iter()
            .copied()
            .collect()
    }

    /// An attribute of the file: only tests ask.
    #[cfg(test)]
    pub fn global(&self, name: &str) -> NcAttrValue {
        self.file.global_attribute(name).unwrap().value.clone()
    }

    /// Texts, the last dimension being that of letters; they end at the first zero, blanks at the end do not count.
    ///
    /// # Errors
    /// It is no text, or the file is cut short or damaged.
    pub fn texts(&self, name: &str) -> Result<Option<Vec<String>>, String> {
        let Some(v) = self.judged(name, self.most[1])? else {
            return Ok(self.find(name).map(|_| vec![]));
        };
        if !matches!(v.dtype, NcType::Char | NcType::String) {
            return Err(other(v, "text"));
        }
        let all = self.file.read_variable_as_strings(name).map_err(told)?;
        Ok(Some(all.iter().map(|t| text(t.as_bytes())).collect()))
    }
}

fn other(v: &NcVariable, wanted: &str) -> String {
    let holds = match v.dtype.is_primitive() {
        true => format!("{:?}", v.dtype),
        false => "what a program has put together itself".into(),
    };
    format!("{} should hold {wanted}, it holds {holds}", v.name)
}

/// An error in words, on one line whatever names the file has.
fn told(error: Error) -> String {
    let text = match &error {
        Error::InvalidMagic => {
            return "it is no netCDF file: it begins neither with CDF nor as HDF5 does".into();
        }
        Error::UnsupportedVersion(version) => {
            return format!(
                "it is netCDF of an unknown version, {version}; 1, 2, 5 and netCDF-4 are read"
            );
        }
        Error::UnsupportedFeature(what) => format!("it has what is not read: {what}"),
        error => format!("the file is cut short or damaged: {error}"),
    };
    let plain = |c: char| match c.is_control() {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    };
    text.chars().map(plain).collect()
}
