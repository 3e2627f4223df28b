"""What classes have in common: equality, attributes, who makes them."""
