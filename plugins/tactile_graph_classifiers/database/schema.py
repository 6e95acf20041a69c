"""The tables of an object database, and what tells it from other SQLite files."""

from __future__ import annotations

APPLICATION_ID = 0x54474F42
"""``TGOB``, in the file's header."""
VERSION = 2

_REAL = "REAL NOT NULL CHECK (typeof({0}) = 'real' AND abs({0}) < 9e999)"
_TEXT = "TEXT NOT NULL CHECK (typeof({0}) = 'text')"
_SEAL = "TEXT NOT NULL CHECK (length({0}) = 64)"

TABLES = f"""
CREATE TABLE about (
    id INTEGER PRIMARY KEY CHECK (id = 1),
    quantity {_TEXT.format("quantity")},
    pipeline {_TEXT.format("pipeline")},
    seal {_SEAL.format("seal")}      -- of all below
);
CREATE TABLE features (
    id INTEGER PRIMARY KEY CHECK (id >= 0),    -- in the order they are measured, from 0
    name {_TEXT.format("name")} UNIQUE
);
CREATE TABLE choice (                -- how a discriminant tells the objects apart best
    id INTEGER PRIMARY KEY CHECK (id = 1),
    shrinkage {_REAL.format("shrinkage")} CHECK (shrinkage > 0 AND shrinkage <= 1),
    variates INTEGER NOT NULL CHECK (variates > 0),
    prior_readings {_REAL.format("prior_readings")} CHECK (prior_readings > 0),
    beyond {_REAL.format("beyond")} CHECK (beyond >= 0),
    n_left_out INTEGER NOT NULL CHECK (n_left_out >= 0),
    n_right INTEGER NOT NULL CHECK (n_right BETWEEN 0 AND n_left_out),
    n_strangers INTEGER NOT NULL CHECK (n_strangers >= 0),
    n_found INTEGER NOT NULL CHECK (n_found BETWEEN 0 AND n_strangers)
);
CREATE TABLE objects (
    id INTEGER PRIMARY KEY,
    name {_TEXT.format("name")} UNIQUE CHECK (length(name) > 0),
    shape {_TEXT.format("shape")},   -- disc, rectangle, ellipse, polygon; empty where nobody said
    learned_at {_TEXT.format("learned_at")},   -- last time, UTC
    n_readings INTEGER NOT NULL CHECK (n_readings > 0),
    seal {_SEAL.format("seal")}      -- of the object with its readings and statistics
);
CREATE TABLE readings (
    id INTEGER PRIMARY KEY,
    object_id INTEGER NOT NULL REFERENCES objects (id) ON DELETE CASCADE,
    source {_TEXT.format("source")}  -- file and frame
);
CREATE INDEX readings_of_object ON readings (object_id);
CREATE TABLE reading_values (
    reading_id INTEGER NOT NULL REFERENCES readings (id) ON DELETE CASCADE,
    feature_id INTEGER NOT NULL REFERENCES features (id),
    value {_REAL.format("value")},
    PRIMARY KEY (reading_id, feature_id)
) WITHOUT ROWID;
CREATE TABLE means (                 -- first order statistics
    object_id INTEGER NOT NULL REFERENCES objects (id) ON DELETE CASCADE,
    feature_id INTEGER NOT NULL REFERENCES features (id),
    mean {_REAL.format("mean")},
    PRIMARY KEY (object_id, feature_id)
) WITHOUT ROWID;
CREATE TABLE scatters (              -- second order: covariance = scatter / (n_readings - 1)
    object_id INTEGER NOT NULL REFERENCES objects (id) ON DELETE CASCADE,
    feature_a INTEGER NOT NULL REFERENCES features (id),
    feature_b INTEGER NOT NULL REFERENCES features (id) CHECK (feature_a <= feature_b),
    scatter {_REAL.format("scatter")},
    PRIMARY KEY (object_id, feature_a, feature_b)
) WITHOUT ROWID
"""

INSTRUMENT = f"""
CREATE TABLE IF NOT EXISTS instrument (     -- made by the first lesson that says it
    id INTEGER PRIMARY KEY CHECK (id = 1),
    rows INTEGER NOT NULL CHECK (rows > 0),
    columns INTEGER NOT NULL CHECK (columns > 0),
    pitch_x_cm {_REAL.format("pitch_x_cm")} CHECK (pitch_x_cm > 0),
    pitch_y_cm {_REAL.format("pitch_y_cm")} CHECK (pitch_y_cm > 0),
    seal {_SEAL.format("seal")}
)
"""
