"""Turns the CSV files of a validation run into the figures, tables and numbers of the article."""
