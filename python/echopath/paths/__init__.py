"""What a record tells: which paths there are, by what way they came, and which powers their rays know."""
