"""The tables of an object database, and what tells it from other SQLite files."""

from __future__ import annotations

APPLICATION_ID = 0x54474F42
"""``TGOB``, in the file's header."""
VERSION = 1

TABLES = """
CREATE TABLE about (
    key TEXT PRIMARY KEY,            -- quantity, pipeline
    value TEXT NOT NULL
) WITHOUT ROWID;
CREATE TABLE features (
    id INTEGER PRIMARY KEY,          -- in the order they are measured, from 0
    name TEXT NOT NULL UNIQUE
);
CREATE TABLE objects (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    shape TEXT NOT NULL,             -- disc, rectangle, ellipse, polygon; empty where nobody said
    learned_at TEXT NOT NULL,        -- last time, UTC
    n_readings INTEGER NOT NULL
);
CREATE TABLE readings (
    id INTEGER PRIMARY KEY,
    object_id INTEGER NOT NULL REFERENCES objects (id) ON DELETE CASCADE,
    source TEXT NOT NULL             -- file and frame
);
CREATE INDEX readings_of_object ON readings (object_id);
CREATE TABLE reading_values (
    reading_id INTEGER NOT NULL REFERENCES readings (id) ON DELETE CASCADE,
    feature_id INTEGER NOT NULL REFERENCES features (id),
    value REAL NOT NULL,
    PRIMARY KEY (reading_id, feature_id)
) WITHOUT ROWID;
CREATE TABLE means (                 -- first order statistics
    object_id INTEGER NOT NULL REFERENCES objects (id) ON DELETE CASCADE,
    feature_id INTEGER NOT NULL REFERENCES features (id),
    mean REAL NOT NULL,
    PRIMARY KEY (object_id, feature_id)
) WITHOUT ROWID;
CREATE TABLE scatters (              -- second order: covariance = scatter / (n_readings - 1)
    object_id INTEGER NOT NULL REFERENCES objects (id) ON DELETE CASCADE,
    feature_a INTEGER NOT NULL REFERENCES features (id),
    feature_b INTEGER NOT NULL REFERENCES features (id),   -- feature_a <= feature_b
    scatter REAL NOT NULL,
    PRIMARY KEY (object_id, feature_a, feature_b)
) WITHOUT ROWID
"""
