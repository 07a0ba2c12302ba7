//! What a road is at one place.

/// Elevation, slope and curvature at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Elevation, positive up [m].
    pub elevation: f64,
    /// Its derivative with respect to x [-].
    pub slope: f64,
    /// Its second derivative with respect to x [1/m].
    pub curvature: f64,
}
